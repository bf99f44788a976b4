/* progress_checks.h - measurement of the time between two cancellation checks of a thread, in its own processor time, so that
   machine load and waiting do not count. The test is linked so that these functions replace those of base/progress.h
   (tests/CMakeLists.txt). Include after test.h, in only one file of a test. */
#pragma once
#include "base/progress.h"

#include <execinfo.h>
#include <pthread.h>
#include <time.h>

#define LOOKS_FRAMES 24

/* State of the whole test. */
static struct Looks {
    pthread_mutex_t lock;
    volatile unsigned round;   /* measurements of threads in another round do not count */
    double longest;            /* seconds */
    void *where[LOOKS_FRAMES]; /* call stack of the second check */
    int frames;
    void (*hook)(void); /* called after each check instead of the measurement; NULL: none */
} looks = { .lock = PTHREAD_MUTEX_INITIALIZER };

/* Accessed by any thread. */
static inline double looks_longest(void)
{
    double longest;
    __atomic_load(&looks.longest, &longest, __ATOMIC_RELAXED);
    return longest;
}

/* Call with the lock held, or while no other thread runs. */
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

/* This thread starts work. */
static inline void looks_begin(void)
{
    looks_set(0.0);
    __atomic_fetch_add(&looks.round, 1, __ATOMIC_ACQ_REL);
    look();
}

/* Work has ended: the longest time between two checks in any thread, ms. */
static inline double looks_end(void)
{
    look();
    return looks_longest() * 1e3;
}

bool __real_wr_progress_cancelled(const WrProgress *progress);
bool __wrap_wr_progress_cancelled(const WrProgress *progress);
bool __wrap_wr_progress_cancelled(const WrProgress *progress)
{
    if (!looks.hook) look();
    const bool result = __real_wr_progress_cancelled(progress);
    if (looks.hook) looks.hook();
    return result;
}

bool __real_wr_progress_step(const WrProgress *progress, double fraction);
bool __wrap_wr_progress_step(const WrProgress *progress, double fraction);
bool __wrap_wr_progress_step(const WrProgress *progress, double fraction)
{
    if (!looks.hook) look();
    const bool result = __real_wr_progress_step(progress, fraction);
    if (looks.hook) looks.hook();
    return result;
}

bool __real_wr_progress_stopped(void);
bool __wrap_wr_progress_stopped(void);
bool __wrap_wr_progress_stopped(void)
{
    if (!looks.hook) look();
    const bool result = __real_wr_progress_stopped();
    if (looks.hook) looks.hook();
    return result;
}

bool __real_wr_progress_report(double fraction);
bool __wrap_wr_progress_report(double fraction);
bool __wrap_wr_progress_report(double fraction)
{
    if (!looks.hook) look();
    const bool result = __real_wr_progress_report(fraction);
    if (looks.hook) looks.hook();
    return result;
}
