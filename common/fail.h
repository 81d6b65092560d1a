/* Failing: one line that names the thing and the reason, then the end of the program. */
#ifndef TEXEL_FAIL_H
#define TEXEL_FAIL_H

#include <stddef.h>

enum { STATUS_FAILURE = 1, STATUS_USAGE = 2 };

/* Prints "PROGRAM: message" as one line on standard error and ends the program with status 1. */
_Noreturn void fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* The same for a mistake on the command line: status 2. */
_Noreturn void fail_usage(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A reason for a function to hand back: one line of at most 511 letters, valid until the thread's next call.
 * It may quote the last one. */
const char *because(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* malloc for count items of size bytes, zeroed; the product is checked, and failure ends the program.
 * The caller frees it with free(). */
void *allocate(size_t count, size_t size);

/* A formatted string of its own; the caller frees it. */
char *text(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
