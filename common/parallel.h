/* Work for all cores. */
#ifndef TEXEL_PARALLEL_H
#define TEXEL_PARALLEL_H

/* Calls work(context, i) once for each i in 0..count-1, on all cores the process may use, in no promised
 * order, and returns when all are done. work must not call parallel_for itself. */
void parallel_for(int count, void (*work)(void *context, int i), void *context);

#endif
