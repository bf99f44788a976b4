/* Memory kept for the next table or picture is released while the window is idle. */
#include "test.h"
#include "app.h"

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

/* True if the block is freed with the next frame, `alone` seconds after the last event and `since` the last
   release. */
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
    for (int i = 0; i < 5; i++) draw_again(bench.app); /* its threads have allocated their memory */
    keep_a_block();
    if (wr_process_space() == 0) skip();    /* unknown on this system */
    assert_false(goes(bench.app, 10, 100)); /* the user may continue soon */
    assert_true(goes(bench.app, 30, 100));
    keep_a_block();
    assert_false(goes(bench.app, 30, 25)); /* no event since */
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
