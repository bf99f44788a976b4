/* looks.h - how long threads work between two looks at whether they should stop: of their own processor's time, so
   that neither a busy machine nor waiting for others counts. The test is linked so that these stand in for the
   functions of base/progress.h (tests/CMakeLists.txt). After test.h; in one file of a test. */
#pragma once
#include "base/progress.h"

#include <execinfo.h>
#include <pthread.h>
#include <time.h>

#define LOOKS_FRAMES 24

/* Of the whole test. */
static struct Looks {
    pthread_mutex_t lock;
    volatile unsigned round;   /* what threads saw in another does not count */
    double longest;            /* seconds */
    void *where[LOOKS_FRAMES]; /* the calls that ended it */
    int frames;
    void (*hook)(void); /* called at each look, in place of measuring; NULL: none */
} looks = { .lock = PTHREAD_MUTEX_INITIALIZER };

/* Read and written by any thread. */
static inline double looks_longest(void)
{
    double longest;
    __atomic_load(&looks.longest, &longest, __ATOMIC_RELAXED);
    return longest;
}

/* The lock is held, but where no other thread works. */
static inline void looks_set(double longest)
{
    __atomic_store(&looks.longest, &longest, __ATOMIC_RELAXED);
}

static inline void look(void)
{
    static _Thread_local unsigned round;
    static _Thread_local double last;
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    const double now = (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
    const unsigned present = __atomic_load_n(&looks.round, __ATOMIC_ACQUIRE);
    if (round == present && now - last > looks_longest()) {
        pthread_mutex_lock(&looks.lock);
        if (now - last > looks_longest()) {
            looks_set(now - last);
            looks.frames = backtrace(looks.where, LOOKS_FRAMES);
        }
        pthread_mutex_unlock(&looks.lock);
    }
    round = present;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    last = (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
}

/* This thread begins to work. */
static inline void looks_begin(void)
{
    looks_set(0.0);
    __atomic_fetch_add(&looks.round, 1, __ATOMIC_ACQ_REL);
    look();
}

/* It has ended: the longest time between two looks of any thread, ms. */
static inline double looks_end(void)
{
    look();
    return looks_longest() * 1e3;
}

bool __real_wr_progress_cancelled(const WrProgress *progress);
bool __wrap_wr_progress_cancelled(const WrProgress *progress);
bool __wrap_wr_progress_cancelled(const WrProgress *progress)
{
    if (looks.hook) looks.hook();
    else look();
    return __real_wr_progress_cancelled(progress);
}

bool __real_wr_progress_step(const WrProgress *progress, double fraction);
bool __wrap_wr_progress_step(const WrProgress *progress, double fraction);
bool __wrap_wr_progress_step(const WrProgress *progress, double fraction)
{
    if (looks.hook) looks.hook();
    else look();
    return __real_wr_progress_step(progress, fraction);
}

bool __real_wr_progress_stopped(void);
bool __wrap_wr_progress_stopped(void);
bool __wrap_wr_progress_stopped(void)
{
    if (looks.hook) looks.hook();
    else look();
    return __real_wr_progress_stopped();
}

bool __real_wr_progress_tell(double fraction);
bool __wrap_wr_progress_tell(double fraction);
bool __wrap_wr_progress_tell(double fraction)
{
    if (looks.hook) looks.hook();
    else look();
    return __real_wr_progress_tell(fraction);
}
