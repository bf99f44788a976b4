/* Background jobs without threads of the system: they run all the same, with one message. */
#include "test.h"

#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"

#include "ui/app/jobs/job.h"

#include <dlfcn.h>
#include <errno.h>
#include <string.h>

static bool none_left; /* the system has no more threads */

/* Overrides the C library's function. */
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                   void *arg)
{
    typedef int Create(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    if (none_left) return EAGAIN;
    void *found = dlsym(RTLD_NEXT, "pthread_create");
    Create *create;
    memcpy(&create, &found, sizeof create);
    return create(thread, attributes, run, arg);
}

typedef struct Piece {
    int value, result;
    const WrProgress *here;
} Piece;

static int dropped;
static WrPool *first; /* pool of in-place work: a piece may keep pointers to it */

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    Piece *piece = arg;
    assert_non_null(pool);
    assert_ptr_equal(wr_progress_here(), progress);
    if (!first) first = pool;
    if (none_left) assert_ptr_equal(pool, first);
    /* it still exists, also for later threads */
    assert_int_equal(wr_pool_threads(first), 1);
    piece->result = piece->value + 1;
}

static void drop(void *arg)
{
    dropped++;
    wr_free(arg);
}

static const WrJobKind kind = { run, drop };

static Piece *piece_of(int value)
{
    Piece *piece = wr_alloc(1, sizeof *piece);
    piece->value = value;
    return piece;
}

static Piece *wait_for(WrJob *job)
{
    Piece *done;
    while (!(done = wr_job_take(job))) {
    }
    return done;
}

static void without_threads_the_work_is_done_in_place(void **state)
{
    (void)state;
    WrJob *job = wr_job_new(&kind, 2, SDL_USEREVENT);
    none_left = true;
    for (int i = 0; i < 3; i++) {
        wr_job_start(job, piece_of(i));
        assert_false(wr_job_busy(job, NULL, NULL));
        assert_null(wr_progress_here());
        Piece *done = wr_job_take(job);
        assert_non_null(done);
        assert_int_equal(done->result, i + 1);
        wr_free(done);
    }
    assert_true(wr_thread_refused());
    assert_false(wr_thread_refused()); /* once is enough */
    wr_job_start(job, piece_of(7));    /* not fetched */
    wr_job_start(job, piece_of(8));
    assert_int_equal(dropped, 1);
    assert_false(wr_thread_refused());
    none_left = false; /* threads are available again */
    wr_job_start(job, piece_of(9));
    Piece *done = wait_for(job);
    assert_int_equal(done->result, 10);
    wr_free(done);
    assert_int_equal(dropped, 2);
    wr_job_free(job);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_threads_the_work_is_done_in_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
