#define _GNU_SOURCE /* program_invocation_short_name, vasprintf */
#include "fail.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static _Noreturn void say_and_exit(int status, const char *format, va_list arguments) {
    fflush(stdout);
    fprintf(stderr, "%s: ", program_invocation_short_name);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    exit(status);
}

void fail(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    say_and_exit(STATUS_FAILURE, format, arguments);
}

void fail_usage(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    say_and_exit(STATUS_USAGE, format, arguments);
}

const char *because(const char *format, ...) {
    static _Thread_local char reason[512];
    char line[sizeof reason];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    return strcpy(reason, line);
}

void *allocate(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size ? size : 1); /* calloc checks the product */
    if (!memory) fail("out of memory: %zu items of %zu bytes", count, size);
    return memory;
}

char *text(const char *format, ...) {
    char *result = NULL;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&result, format, arguments) < 0) fail("out of memory");
    va_end(arguments);
    return result;
}
