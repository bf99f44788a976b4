/* thread.h - threads, mutexes and condition variables.

   The types contain the system's own, so that they can be struct members; use them only by these
   functions. C threads are not used because sanitizers do not support them and macOS lacks them.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <pthread.h>
#include <stdbool.h>

typedef struct WrMutex {
    pthread_mutex_t it;
} WrMutex;

typedef struct WrCond {
    pthread_cond_t it;
} WrCond;

typedef struct WrThread {
    pthread_t it;
} WrThread;

/* Static initialisers. */
#define WR_MUTEX_READY                                                                             \
    {                                                                                              \
        PTHREAD_MUTEX_INITIALIZER                                                                  \
    }
#define WR_COND_READY                                                                              \
    {                                                                                              \
        PTHREAD_COND_INITIALIZER                                                                   \
    }

void wr_mutex_init(WrMutex *mutex);
void wr_mutex_fini(WrMutex *mutex);
void wr_mutex_lock(WrMutex *mutex);
void wr_mutex_unlock(WrMutex *mutex);

void wr_cond_init(WrCond *cond);
void wr_cond_fini(WrCond *cond);
void wr_cond_wait(WrCond *cond, WrMutex *mutex); /* may return spuriously */
/* Waits at most about that long; on a monotonic clock where the system has one. */
void wr_cond_wait_ms(WrCond *cond, WrMutex *mutex, int ms);
void wr_cond_wake(WrCond *cond);     /* one waiter */
void wr_cond_wake_all(WrCond *cond); /* all waiters */

typedef void *(*WrThreadMain)(void *arg);
bool wr_thread_begin(WrThread *thread, WrThreadMain run,
                     void *arg); /* false: no thread available */
void wr_thread_join(WrThread thread);
/* Starts a detached thread without signals; threads that it starts inherit that. */
bool wr_thread_begin_detached(WrThreadMain run, void *arg);

/* Lowers the priority of the calling thread and of threads it starts. Does nothing where priorities
   apply only to processes. */
void wr_thread_step_back(void);

/* Pins the calling thread to its present processor, so that cache and clock rate stay stable for
 * measurements. */
typedef struct WrPin {
    bool held;
    unsigned char before[1024]; /* private: previous affinity */
} WrPin;
bool wr_thread_pin(WrPin *pin); /* false if unsupported */
void wr_thread_unpin(const WrPin *pin);

int wr_thread_processors(void); /* processors online; at least 1 */
void wr_thread_sleep_ms(int ms);
