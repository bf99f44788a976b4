/* The whole window without a display: a pointer scribbles, the table is painted, and the latency is measured. */
#include "test.h"

#include "base/error.h"
#include "base/pool.h"
#include "document/document.h"
#include "field/field.h"

#include "ui/app/app.h"

static WrSession *session_of(WrPool *pool)
{
    WrError err = { "" };
    WrSessionOptions options = { .pool = pool, .outputs = true };
    WrSession *session = wr_session_new(&options);
    if (!wr_session_run(session, "table 256x256", &err)) fail_msg("%s", err.text);
    if (!wr_session_run(session, "surface sphere", &err)) fail_msg("%s", err.text);
    return session;
}

static void assert_ordered(const WrAppDelays *ms)
{
    assert_true(ms->half > 0 && ms->half <= ms->most);
    assert_true(ms->most <= ms->nearly_all && ms->nearly_all <= ms->all);
    assert_true(isfinite(ms->all));
}

/* Scribble in a new session; repeated if the machine was too busy for enough frames; the caller frees it. */
static WrSession *scribble(WrPool *pool, bool turning, WrAppLatency *latency)
{
    enum { TRIES = 5 };
    for (int k = 1;; k++) {
        WrError err = { "" };
        WrSession *session = session_of(pool);
        const WrAppOptions options = { .session = session, .threads = 2 };
        *latency = (WrAppLatency){ .radius = 8, .seconds = 1, .turning = turning };
        if (!wr_app_latency(&options, latency, &err)) fail_msg("%s", err.text);
        const bool soon = latency->pictures > 10 && latency->events == 125 &&
                          latency->canvas.half >= latency->pointer.half * 0.5;
        if (soon || k == TRIES) return session;
        wr_session_free(session);
    }
}

static void a_scribble_in_the_window_is_painted_and_timed(void **state)
{
    (void)state;
    WrPool *pool = wr_pool_new(2);
    for (int turning = 0; turning < 2; turning++) {
        WrAppLatency latency;
        WrSession *unpainted = session_of(pool);
        const int before = wr_session_history_count(unpainted);
        WrSession *session = scribble(pool, turning, &latency);
        wr_session_free(unpainted);
        assert_int_equal(latency.events, 125); /* of the pace that was promised */
        assert_true(latency.pictures > 10);
        assert_ordered(&latency.pointer);
        assert_ordered(&latency.canvas);
        assert_ordered(&latency.preview);
        /* the paint is not visible before the pointer */
        assert_true(latency.canvas.half >= latency.pointer.half * 0.5);
        /* one stroke, as one step, that starts with the scribble */
        assert_false(wr_session_in_stroke(session));
        assert_int_equal(wr_session_history_count(session), before + 1);
        assert_non_null(strstr(wr_session_last_command(session), "stroke "));
        assert_non_null(strstr(wr_session_last_command(session), "radius=8 "));
        float low, high;
        wr_field_range(wr_document_field(wr_session_document(session)), &low, &high);
        /* its strength, without overlaps */
        assert_true(low == 0 && high > 0.0199f && high <= 0.02f);
        wr_session_free(session);
    }
    wr_pool_free(pool);
}

/* A stroke drawn a few milliseconds at a time equals the command as a whole. */
static void a_stroke_drawn_by_and_by_replays_to_the_same_bits(void **state)
{
    (void)state;
    WrPool *pool = wr_pool_new(2);
    WrError err = { "" };
    WrSession *session = session_of(pool), *again = session_of(pool);
    WrAppOptions options = { .session = session, .threads = 2 };
    WrAppLatency latency = { .radius = 60, .seconds = 0.8 };
    if (!wr_app_latency(&options, &latency, &err)) fail_msg("%s", err.text);
    if (!wr_session_run(again, wr_session_last_command(session), &err)) fail_msg("%s", err.text);
    WrHash a = wr_session_hash(session), b = wr_session_hash(again);
    assert_memory_equal(&a, &b, sizeof a);
    wr_session_free(session);
    wr_session_free(again);
    wr_pool_free(pool);
}

static void times_out_of_range_are_refused(void **state)
{
    (void)state;
    const double bad[] = { 0, -1, 0.4, 601, NAN, INFINITY };
    WrSession *session = session_of(NULL);
    WrAppOptions options = { .session = session };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        WrError err = { "" };
        WrAppLatency latency = { .radius = 8, .seconds = bad[i] };
        assert_false(wr_app_latency(&options, &latency, &err));
        assert_non_null(strstr(err.text, "0.5..600"));
    }
    wr_session_free(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scribble_in_the_window_is_painted_and_timed),
        cmocka_unit_test(a_stroke_drawn_by_and_by_replays_to_the_same_bits),
        cmocka_unit_test(times_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
