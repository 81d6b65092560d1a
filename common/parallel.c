#define _GNU_SOURCE /* sched_getaffinity */
#include "parallel.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

enum { THREADS_MAX = 64 };

typedef struct {
    atomic_int next; /* the first index that nobody has taken yet */
    int count;
    void (*work)(void *, int);
    void *context;
} Job;

static void *work_until_done(void *argument) {
    Job *job = argument;
    for (int i; (i = atomic_fetch_add(&job->next, 1)) < job->count;) job->work(job->context, i);
    return NULL;
}

static int core_count(void) {
    cpu_set_t set;
    int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    return count < THREADS_MAX ? count : THREADS_MAX;
}

void parallel_for(int count, void (*work)(void *context, int i), void *context) {
    Job job = {.next = 0, .count = count, .work = work, .context = context};
    pthread_t threads[THREADS_MAX];
    int started = 0, helpers = core_count() - 1; /* this thread works too */
    while (started < helpers && started < count - 1 &&
           pthread_create(&threads[started], NULL, work_until_done, &job) == 0)
        started++;
    work_until_done(&job);
    for (int i = 0; i < started; i++) pthread_join(threads[i], NULL);
}
