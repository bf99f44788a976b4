#include "base/aside.h"

#include "base/progress.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#define LOOK_MS 20 /* between two looks at whether somebody wants it to stop */

/* Of all that is done so: how many are under way is a fact of the process. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
static int under_way;

/* A library that is being loaded holds a lock that the program's end waits for. */
static void leave_at_once(int status, void *ctx)
{
    (void)ctx;
    pthread_mutex_lock(&lock);
    bool busy = under_way > 0;
    pthread_mutex_unlock(&lock);
    if (!busy) return;
    fflush(NULL);
    _exit(status);
}

void wr_aside_watch_end(void)
{
    static bool watching;
    pthread_mutex_lock(&lock);
    if (!watching) watching = on_exit(leave_at_once, NULL) == 0;
    pthread_mutex_unlock(&lock);
}

/* The lock is held, and let go meanwhile. */
static void work_here(WrAside *aside)
{
    WrError why = { "" };
    pthread_mutex_unlock(&lock);
    bool good = aside->work(aside->ctx, &why);
    pthread_mutex_lock(&lock);
    aside->why = why;
    aside->done = good;
    aside->busy = false;
    under_way--;
    pthread_cond_broadcast(&changed);
}

static void *thread_main(void *aside)
{
    pthread_mutex_lock(&lock);
    work_here(aside);
    pthread_mutex_unlock(&lock);
    return NULL;
}

/* Signals are for the threads that were there before; threads that libraries start inherit that. */
static bool start_thread(WrAside *aside)
{
    sigset_t all, before;
    pthread_t thread;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    bool good = pthread_create(&thread, NULL, thread_main, aside) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (good) pthread_detach(thread);
    return good;
}

/* The lock is held. here: on this thread, as well as where there is no other to be had. */
static void begin(WrAside *aside, bool here)
{
    if (aside->done || aside->busy) return;
    aside->busy = true;
    under_way++;
    if (here || !start_thread(aside)) work_here(aside);
}

static void wait_a_moment(void)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += LOOK_MS * 1000000L;
    until.tv_sec += until.tv_nsec / 1000000000L;
    until.tv_nsec %= 1000000000L;
    pthread_cond_clockwait(&changed, &lock, CLOCK_MONOTONIC, &until);
}

void wr_aside_begin(WrAside *aside)
{
    wr_aside_watch_end();
    pthread_mutex_lock(&lock);
    begin(aside, false);
    pthread_mutex_unlock(&lock);
}

bool wr_aside_wait(WrAside *aside, WrError *err)
{
    bool stopped = false;
    wr_aside_watch_end();
    pthread_mutex_lock(&lock);
    begin(aside, wr_progress_here() == NULL);
    while (aside->busy && !(stopped = wr_progress_stopped())) wait_a_moment();
    bool done = aside->done;
    if (!done) wr_fail(err, "%s", stopped ? "cancelled" : aside->why.text);
    pthread_mutex_unlock(&lock);
    return done;
}
