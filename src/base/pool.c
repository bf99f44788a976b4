#include "base/pool.h"
#include "base/memory.h"

#include <pthread.h>
#include <stdbool.h>
#include <unistd.h>

typedef struct Worker {
    WrPool *pool;
    int id;
    pthread_t thread;
} Worker;

struct WrPool {
    pthread_mutex_t run_lock; /* one run at a time */
    pthread_mutex_t lock;     /* guards what follows */
    pthread_cond_t wake, done;
    unsigned generation; /* counts runs */
    int active;          /* workers inside the present run */
    bool quit;
    int next; /* next piece; atomic */
    int count;
    WrPiece piece;
    void *ctx;
    int threads; /* the caller included */
    Worker *workers;
};

static void take_pieces(WrPool *pool, int worker)
{
    for (;;) {
        int index = __atomic_fetch_add(&pool->next, 1, __ATOMIC_RELAXED);
        if (index >= pool->count) return;
        pool->piece(index, worker, pool->ctx);
    }
}

static void *worker_main(void *arg)
{
    Worker *self = arg;
    WrPool *pool = self->pool;
    unsigned seen = 0;
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (pool->generation == seen && !pool->quit) pthread_cond_wait(&pool->wake, &pool->lock);
        if (pool->quit) break;
        seen = pool->generation;
        pthread_mutex_unlock(&pool->lock);
        take_pieces(pool, self->id);
        pthread_mutex_lock(&pool->lock);
        if (--pool->active == 0) pthread_cond_signal(&pool->done);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

WrPool *wr_pool_new(int threads)
{
    if (threads <= 0) threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
    if (threads < 1) threads = 1;
    if (threads > 256) threads = 256;
    WrPool *pool = wr_alloc(1, sizeof *pool);
    pthread_mutex_init(&pool->run_lock, NULL);
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->done, NULL);
    pool->workers = wr_alloc((size_t)threads, sizeof *pool->workers);
    pool->threads = 1;
    for (int i = 1; i < threads; i++) {
        Worker *worker = &pool->workers[i];
        *worker = (Worker){ .pool = pool, .id = i };
        if (pthread_create(&worker->thread, NULL, worker_main, worker) != 0) break;
        pool->threads++;
    }
    return pool;
}

void wr_pool_free(WrPool *pool)
{
    if (!pool) return;
    pthread_mutex_lock(&pool->lock);
    pool->quit = true;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    for (int i = 1; i < pool->threads; i++) pthread_join(pool->workers[i].thread, NULL);
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->wake);
    pthread_mutex_destroy(&pool->lock);
    pthread_mutex_destroy(&pool->run_lock);
    wr_free(pool->workers);
    wr_free(pool);
}

int wr_pool_threads(const WrPool *pool)
{
    return pool ? pool->threads : 1;
}

void wr_pool_run(WrPool *pool, int count, WrPiece piece, void *ctx)
{
    if (count <= 0) return;
    if (!pool || pool->threads == 1 || count == 1) {
        /* A pool of one still lets only one run in at a time: scratch memory goes by worker. */
        if (pool) pthread_mutex_lock(&pool->run_lock);
        for (int i = 0; i < count; i++) piece(i, 0, ctx);
        if (pool) pthread_mutex_unlock(&pool->run_lock);
        return;
    }
    pthread_mutex_lock(&pool->run_lock);
    pthread_mutex_lock(&pool->lock);
    pool->piece = piece;
    pool->ctx = ctx;
    pool->count = count;
    __atomic_store_n(&pool->next, 0, __ATOMIC_RELAXED);
    pool->active = pool->threads - 1;
    pool->generation++;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    take_pieces(pool, 0);
    pthread_mutex_lock(&pool->lock);
    while (pool->active > 0) pthread_cond_wait(&pool->done, &pool->lock);
    pthread_mutex_unlock(&pool->lock);
    pthread_mutex_unlock(&pool->run_lock);
}
