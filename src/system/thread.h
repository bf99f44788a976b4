/* thread.h - threads, and what they wait for. The types are the system's own, so that they can stand in a struct; only
   these functions are asked for anything.
   Why not those of C: sanitizers do not see them, and macOS has none.
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

/* Of what is not made by the functions below but is there from the start. */
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
void wr_cond_wait(WrCond *cond, WrMutex *mutex); /* may return without cause */
/* At most about that long, whatever is done to the clock where the system has a better one. */
void wr_cond_wait_ms(WrCond *cond, WrMutex *mutex, int ms);
void wr_cond_wake(WrCond *cond);     /* one that waits */
void wr_cond_wake_all(WrCond *cond); /* all that wait */

typedef void *(*WrThreadMain)(void *arg);
bool wr_thread_begin(WrThread *thread, WrThreadMain run,
                     void *arg); /* false: the system gives none */
void wr_thread_join(WrThread thread);
/* One that nobody joins and no signal reaches; threads that it starts inherit that. */
bool wr_thread_begin_aside(WrThreadMain run, void *arg);

/* The calling thread, and those that it starts, work only when nobody else wants to; where a thread cannot be told
   alone, nothing happens. */
void wr_thread_step_back(void);

/* The calling thread stays on the processor that it is on, so that caches and clock rate stay with it. */
typedef struct WrPin {
    bool held;
    unsigned char before[1024]; /* private: where it might be until then */
} WrPin;
bool wr_thread_pin(WrPin *pin); /* false if it cannot be done */
void wr_thread_unpin(const WrPin *pin);

int wr_thread_processors(void); /* that work now; at least 1 */
void wr_thread_sleep_ms(int ms);
