/* What the status line says, and what waits to be read. */
#include "test.h"

#include "base/clock.h"
#include "base/memory.h"
#include "ui/state.h"

#include <string.h>

#define LATER 1e9 /* of the clock: notes are old by then */

static const char *shown(const WrApp *app, double now)
{
    const WrMessage *message = wr_messages_shown(&app->messages, now);
    return message ? message->text : "";
}

static void fail_with(WrApp *app, const char *text)
{
    WrError err;
    wr_fail(&err, "%s", text);
    wr_app_fail(app, &err);
}

static void the_newest_message_is_what_is_seen(void **state)
{
    (void)state;
    WrApp *app = wr_alloc(1, sizeof *app);
    double now = wr_clock_seconds();
    assert_string_equal(shown(app, now), "");
    fail_with(app, "the disk is full");
    assert_string_equal(shown(app, LATER), "the disk is full"); /* until it is read */
    wr_app_say(app, "Saved elsewhere");
    assert_string_equal(shown(app, now), "Saved elsewhere");
    assert_string_equal(shown(app, LATER), ""); /* the line is free again ... */
    assert_int_equal(app->messages.unread, 1);  /* ... but for the count */
    fail_with(app, "no such file");
    assert_string_equal(shown(app, LATER), "no such file");
    assert_int_equal(app->messages.unread, 2);
    app->messages.unread = 0;
    assert_string_equal(shown(app, now), "");
    wr_messages_free(&app->messages);
    wr_free(app);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_newest_message_is_what_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
