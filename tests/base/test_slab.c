/* Pieces of large blocks: exclusive, valid while in use, and released afterwards. */
#include "test.h"

#include "base/memory.h"
#include "base/pool.h"
#include "base/slab.h"
#include "system/process.h"

#include <string.h>

#define BYTES 16449 /* some 500 to a block */
#define MANY 9000
#define BLOCK ((uint64_t)8 << 20)

static WrSlabs slabs = { WR_SLABS_OF(BYTES) };

/* Its first and last bytes identify the owner. */
static void mark(unsigned char *piece, unsigned owner)
{
    memcpy(piece, &owner, sizeof owner);
    memcpy(piece + BYTES - sizeof owner, &owner, sizeof owner);
}

static bool is_marked(const unsigned char *piece, unsigned owner)
{
    return memcmp(piece, &owner, sizeof owner) == 0 &&
           memcmp(piece + BYTES - sizeof owner, &owner, sizeof owner) == 0;
}

/* The first test, since the C library returns memory less readily later. */
static void blocks_of_which_nothing_is_out_go_back_but_for_ten(void **state)
{
    (void)state;
#ifndef __SANITIZE_ADDRESS__
    static void *piece[MANY];
    const uint64_t before = wr_process_space();
    for (int i = 0; i < MANY; i++) piece[i] = wr_slab_alloc(&slabs);
    const uint64_t most = wr_process_space();
    for (int i = 0; i < MANY; i += 2) wr_slab_free(&slabs, piece[i]);
    for (int i = 0; i < MANY; i += 2) piece[i] = wr_slab_alloc(&slabs);
    assert_true(wr_process_space() <= most + BLOCK); /* returned pieces are reused first */
    for (int i = 0; i < MANY; i++) wr_slab_free(&slabs, piece[i * 7 % MANY]);
    if (before == 0) skip(); /* unknown on this system */
    assert_true(most >= before + (uint64_t)MANY * BYTES);
    assert_true(wr_process_space() <= before + 11 * BLOCK); /* of 18 */
    wr_slab_trim(&slabs);
    assert_true(wr_process_space() <= before + BLOCK);
#endif
}

static void pieces_are_kept_while_they_are_out(void **state)
{
    (void)state;
    static unsigned char *piece[MANY];
    TestRandom random = { 41 };
    for (unsigned step = 0; step < 5 * MANY; step++) {
        const unsigned i = (unsigned)(test_random_u64(&random) % MANY);
        if (piece[i]) {
            assert_true(is_marked(piece[i], i));
            wr_slab_free(&slabs, piece[i]);
            piece[i] = NULL;
        } else {
            piece[i] = wr_slab_alloc(&slabs);
            assert_true((uintptr_t)piece[i] % WR_ALIGN == 0);
            mark(piece[i], i);
        }
    }
    for (unsigned i = 0; i < MANY; i++) {
        if (piece[i]) assert_true(is_marked(piece[i], i));
        wr_slab_free(&slabs, piece[i]); /* NULL does nothing */
    }
}

static void take_and_give(int index, int worker, void *ctx)
{
    (void)worker;
    unsigned char *piece[60];
    for (unsigned i = 0; i < 60; i++)
        mark(piece[i] = wr_slab_alloc(&slabs), (unsigned)index << 8 | i);
    for (unsigned i = 0; i < 60; i++) {
        if (!is_marked(piece[i], (unsigned)index << 8 | i))
            __atomic_fetch_add((int *)ctx, 1, __ATOMIC_RELAXED);
        wr_slab_free(&slabs, piece[i]);
    }
}

static void several_threads_get_pieces_of_their_own(void **state)
{
    (void)state;
    int wrong = 0;
    WrPool *pool = wr_pool_new(4);
    wr_pool_run(pool, 3000, take_and_give, &wrong);
    wr_pool_free(pool);
    assert_int_equal(wrong, 0);
}

/* Large blocks of any content: two returned ones of about the requested size are kept until the next trim. */
static void two_large_blocks_are_kept_for_the_next(void **state)
{
    (void)state;
#ifndef __SANITIZE_ADDRESS__
    const size_t bytes = 37 << 20;
    wr_memory_trim();
    const uint64_t before = wr_process_space();
    char *block[3];
    for (int i = 0; i < 3; i++) {
        block[i] = wr_try_alloc_unset(bytes + (size_t)i, 1, "a block", NULL);
        memset(block[i], 'a' + i, bytes + (size_t)i);
    }
    for (int i = 0; i < 3; i++) wr_free(block[i]);
    char *zeroed = wr_try_alloc(bytes, 1, "a block", NULL), *wide, *narrow, *last;
    for (size_t i = 0; i < bytes; i += 4093) assert_int_equal(zeroed[i], 0);
    wide = wr_try_alloc_unset(bytes + 3, 1, "a block", NULL);       /* too large for both */
    narrow = wr_try_alloc_unset(bytes / 2 - 1, 1, "a block", NULL); /* not worth one */
    last = wr_try_alloc_unset(bytes + 2, 1, "a block", NULL);
    assert_true(wide != block[1] && wide != block[2] && narrow != block[1] && narrow != block[2]);
    assert_ptr_equal(last, block[2]);
    assert_true(last[0] == 'c' && last[bytes + 1] == 'c');
    wr_free(last), wr_free(narrow), wr_free(wide), wr_free(zeroed);
    wr_memory_trim();
    if (before) assert_true(wr_process_space() < before + bytes);
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_of_which_nothing_is_out_go_back_but_for_ten),
        cmocka_unit_test(pieces_are_kept_while_they_are_out),
        cmocka_unit_test(several_threads_get_pieces_of_their_own),
        cmocka_unit_test(two_large_blocks_are_kept_for_the_next),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
