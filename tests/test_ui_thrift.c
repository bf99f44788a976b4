/* What is kept for the next table or picture is given back to the system while nobody uses the window. */
#include "test.h"
#include "test_app.h"

#include "base/memory.h"
#include "system/clock.h"
#include "system/process.h"

#include <string.h>

#define BLOCK ((size_t)117 << 20)

static void keep_a_block(void)
{
    char *block = wr_try_alloc_unset(BLOCK, 1, "a block", NULL);
    assert_non_null(block);
    memset(block, 7, BLOCK);
    wr_free(block);
}

/* Whether the block goes with the next picture, so long after the last event and the last time that it did. */
static bool goes(WrApp *app, double alone, double since)
{
    const double now = wr_clock_seconds();
    const uint64_t before = wr_process_space();
    app->input_at = now - alone;
    app->thrifty_at = now - since;
    draw_again(app);
    return wr_process_space() + BLOCK / 2 < before;
}

static void a_window_that_is_left_alone_gives_memory_back(void **state)
{
    (void)state;
#ifdef __SANITIZE_ADDRESS__
    skip(); /* none is kept */
#endif
    Bench bench;
    begin(&bench);
    for (int i = 0; i < 5; i++) draw_again(bench.app); /* its threads have what they need */
    keep_a_block();
    if (wr_process_space() == 0) skip();    /* the system does not tell */
    assert_false(goes(bench.app, 10, 100)); /* somebody may go on in a moment */
    assert_true(goes(bench.app, 30, 100));
    keep_a_block();
    assert_false(goes(bench.app, 30, 25)); /* nothing was asked of it since */
    assert_true(goes(bench.app, 30, 35));
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_window_that_is_left_alone_gives_memory_back),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}
