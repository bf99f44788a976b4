#include "system/thread.h"

#include <signal.h>
#include <stddef.h>
#include <time.h>
#include <unistd.h>

void wr_mutex_init(WrMutex *mutex)
{
    pthread_mutex_init(&mutex->it, NULL);
}

void wr_mutex_fini(WrMutex *mutex)
{
    pthread_mutex_destroy(&mutex->it);
}

void wr_mutex_lock(WrMutex *mutex)
{
    pthread_mutex_lock(&mutex->it);
}

void wr_mutex_unlock(WrMutex *mutex)
{
    pthread_mutex_unlock(&mutex->it);
}

void wr_cond_init(WrCond *cond)
{
    pthread_cond_init(&cond->it, NULL);
}

void wr_cond_fini(WrCond *cond)
{
    pthread_cond_destroy(&cond->it);
}

void wr_cond_wait(WrCond *cond, WrMutex *mutex)
{
    pthread_cond_wait(&cond->it, &mutex->it);
}

void wr_cond_wake(WrCond *cond)
{
    pthread_cond_signal(&cond->it);
}

void wr_cond_wake_all(WrCond *cond)
{
    pthread_cond_broadcast(&cond->it);
}

bool wr_thread_begin(WrThread *thread, WrThreadMain run, void *arg)
{
    return pthread_create(&thread->it, NULL, run, arg) == 0;
}

void wr_thread_join(WrThread thread)
{
    pthread_join(thread.it, NULL);
}

bool wr_thread_begin_detached(WrThreadMain run, void *arg)
{
    sigset_t all, before;
    pthread_t thread;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    bool good = pthread_create(&thread, NULL, run, arg) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (good) pthread_detach(thread);
    return good;
}

int wr_thread_processors(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > 65536 ? 65536 : (int)count;
}

void wr_thread_sleep_ms(int ms)
{
    struct timespec time = { ms / 1000, ms % 1000 * 1000000L };
    nanosleep(&time, NULL);
}
