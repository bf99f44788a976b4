/* Messages of the status line, and unread messages. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "system/clock.h"

#include "ui/app/loop.h"
#include "ui/app/state/messages.h"
#include "ui/patch/preview/preview.h"

#include <math.h>
#include <string.h>

#define LATER 1e9 /* clock at which notes have expired */

static const char *shown(const WrApp *app, double now)
{
    const WrMessage *message = wr_messages_shown(app->messages, now);
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
    WrApp *app = wr_store_new();
    double now = wr_clock_seconds();
    assert_string_equal(shown(app, now), "");
    fail_with(app, "the disk is full");
    assert_string_equal(shown(app, LATER), "the disk is full"); /* until it is read */
    wr_app_say(app, "Saved elsewhere");
    assert_string_equal(shown(app, now), "Saved elsewhere");
    assert_string_equal(shown(app, LATER), ""); /* the line is free again ... */
    assert_int_equal(app->messages->unread, 1); /* ... except for the count */
    fail_with(app, "no such file");
    assert_string_equal(shown(app, LATER), "no such file");
    assert_int_equal(app->messages->unread, 2);
    /* an action begun before the error does not outdate it */
    wr_messages_overtake(app->messages, now - 1);
    assert_string_equal(shown(app, LATER), "no such file");
    wr_messages_overtake(app->messages, LATER);
    assert_int_equal(app->messages->unread, 0);
    assert_string_equal(shown(app, LATER), "");
    fail_with(app, "no such font");
    assert_int_equal(app->messages->unread, 1); /* only new ones are counted */
    app->messages->unread = 0;
    assert_string_equal(shown(app, now), "");
    wr_messages_free(app->messages);
    wr_free(app);
}

/* The status line, the Accuracy tab and the Plan tab show the same time, and its parts add up to it. */
static void a_picture_has_one_time(void **state)
{
    (void)state;
    WrPreviewPicture picture = { .width = 640,
                                 .height = 480,
                                 .level = WR_PREVIEW_SMOOTH,
                                 .seconds = 0.0123,
                                 .times = { .prepare = 0.001, .bump = 0.03, .shade = 0.004 } };
    double ms[WR_PICTURE_STAGES], sum = 0.0;
    char words[WR_PICTURE_WORDS];
    assert_true(fabs(wr_picture_time(&picture, ms) - 12.3) < 1e-9);
    for (int i = 0; i < WR_PICTURE_STAGES; i++) sum += ms[i];
    assert_true(fabs(sum - 12.3) < 1e-9);
    assert_true(fabs(ms[3] - 12.3 * 30.0 / 35.0) < 1e-9);
    wr_picture_words(&picture, words);
    assert_true(strncmp(words, "12.3 ms ", 8) == 0 && strstr(words, "640 \xc3\x97 480") != NULL);
    picture.times = (WrStageTimes){ 0 };
    wr_picture_time(&picture, ms);
    assert_true(ms[0] == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_newest_message_is_what_is_seen),
        cmocka_unit_test(a_picture_has_one_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
