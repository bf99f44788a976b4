/* pool.h - a blocking pool of threads for jobs that are cut into pieces.
   Waiting threads sleep: an idle program uses no processor. Layer 0. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrPool WrPool;

/* threads 0 means one per processor. The caller of run is one of them, so a pool of 1 starts none.
   Never fails; if a thread cannot be started the pool is smaller. */
WrPool *wr_pool_new(int threads);
void wr_pool_free(WrPool *pool);         /* NULL is fine; no run may be under way */
int wr_pool_threads(const WrPool *pool); /* how many work, the caller included; NULL gives 1 */

/* Call piece(index, worker, ctx) once for each index in 0..count-1, on any thread and in any order,
   and return when all are done. worker is 0..threads-1, never in use twice at a time: index scratch
   memory by it. pool may be NULL: then all run here. One run at a time; a second caller waits.
   A piece must not call wr_pool_run on the same pool.
   Where the caller's own progress (progress.h) is cancelled, pieces that have not begun are left out: then it
   returns false. Pieces have that progress as their own, but only the caller's may report. */
typedef void (*WrPiece)(int index, int worker, void *ctx);
bool wr_pool_run(WrPool *pool, int count, WrPiece piece, void *ctx);
/* The same, and the caller's own progress is told which part of the pieces was begun. */
bool wr_pool_run_told(WrPool *pool, int count, WrPiece piece, void *ctx);

/* Pieces that this process has begun so far, for tests that count work. */
int64_t wr_pool_pieces(void);
