/* A brush as a command's arguments: parsing the line restores the brush. */
#include "test.h"

#include "base/error.h"
#include "base/text.h"
#include "command/session_internal.h"

#include "ui/canvas/tools/brush_command_text.h"

static char *line_of(const WrBrush *brush, const WrBrushNames *names)
{
    static char text[1024];
    WrBrush base = wr_brush_default();
    WrText line = { 0 };
    wr_text_add(&line, "stroke");
    wr_brush_line(&line, brush, &base, names);
    snprintf(text, sizeof text, "%s", wr_text_get(&line));
    wr_text_fini(&line);
    return text;
}

static const WrBrushNames none = { NULL, NULL, NULL };

static void a_plain_brush_makes_a_short_line(void **state)
{
    (void)state;
    WrBrush brush = wr_brush_default();
    assert_string_equal(line_of(&brush, &none),
                        "stroke radius=16 hardness=0.5 strength=0.1 mode=raise");
    brush.reach = 3; /* irrelevant for a mode that does not use it */
    brush.source_u = 0.25;
    brush.to = 7;
    assert_string_equal(line_of(&brush, &none),
                        "stroke radius=16 hardness=0.5 strength=0.1 mode=raise");
}

static void assert_same(const WrBrush *a, const WrBrush *b)
{
    const WrSymmetry *s = &a->symmetry, *t = &b->symmetry;
    assert_true(a->radius == b->radius && a->hardness == b->hardness);
    assert_true(a->strength == b->strength && a->mode == b->mode);
    assert_true(a->opacity == b->opacity && a->flow == b->flow && a->buildup == b->buildup);
    assert_true(a->spacing == b->spacing && a->pressure == b->pressure && a->seed == b->seed);
    assert_true(a->angle_deg == b->angle_deg && a->aspect == b->aspect && a->follow == b->follow);
    assert_true(a->jitter_place == b->jitter_place && a->jitter_size == b->jitter_size);
    assert_true(a->jitter_angle_deg == b->jitter_angle_deg);
    assert_true(s->mirror_u == t->mirror_u && s->mirror_v == t->mirror_v);
    assert_int_equal(s->radial > 1 ? s->radial : 1, t->radial > 1 ? t->radial : 1);
    assert_int_equal(s->repeat_u > 1 ? s->repeat_u : 1, t->repeat_u > 1 ? t->repeat_u : 1);
    assert_int_equal(s->repeat_v > 1 ? s->repeat_v : 1, t->repeat_v > 1 ? t->repeat_v : 1);
    assert_true(s->stagger == t->stagger);
    unsigned uses = wr_brush_modes[a->mode].uses;
    if (uses & WR_USES_TO) assert_true(a->to == b->to);
    if (uses & WR_USES_REACH) assert_true(a->reach == b->reach);
    if (uses & WR_USES_SOURCE) assert_true(a->source_u == b->source_u);
    if (uses & WR_USES_SOURCE) assert_true(a->source_v == b->source_v);
    bool centred = s->mirror_u || s->mirror_v || s->radial > 1;
    if (centred) assert_true(s->centre_u == t->centre_u && s->centre_v == t->centre_v);
}

static double some(TestRandom *random, double low, double high)
{
    return test_random(random) < 0.5 ? low : low + (high - low) * test_random(random);
}

static WrBrush any_brush(TestRandom *random)
{
    WrBrush b = wr_brush_default();
    b.radius = some(random, 1, 300);
    b.hardness = some(random, 0, 1);
    b.strength = some(random, -2, 2);
    b.mode = (WrBrushMode)(test_random_u64(random) % WR_BRUSH_MODE_COUNT);
    b.to = some(random, -1, 1);
    b.opacity = some(random, 1, 0);
    b.flow = some(random, 1, 0);
    b.buildup = test_random(random) < 0.3;
    b.spacing = some(random, 0.01, 3);
    b.reach = some(random, 0, 30);
    b.pressure = (WrBrushPressure)(test_random_u64(random) % WR_PRESSURE_COUNT);
    b.source_u = some(random, 0, 1);
    b.source_v = some(random, 0, -1);
    b.angle_deg = some(random, 0, 90);
    b.aspect = some(random, 1, 5);
    b.follow = test_random(random) < 0.3;
    b.jitter_place = some(random, 0, 1);
    b.jitter_angle_deg = some(random, 0, 180);
    b.jitter_size = some(random, 0, 1);
    b.seed = test_random(random) < 0.5 ? 0 : test_random_u64(random) % 999999999u;
    b.symmetry = (WrSymmetry){ .mirror_u = test_random(random) < 0.3,
                               .mirror_v = test_random(random) < 0.3,
                               .radial = (int)(test_random_u64(random) % 7),
                               .centre_u = some(random, 0.5, 0.9),
                               .centre_v = some(random, 0.5, 0.1),
                               .repeat_u = 2 * (int)(test_random_u64(random) % 3),
                               .repeat_v = (int)(test_random_u64(random) % 3) };
    if (b.symmetry.repeat_u > 0) b.symmetry.stagger = some(random, 0, 0) + 0.5;
    return b;
}

static void what_is_printed_reads_back_as_the_same_brush(void **state)
{
    (void)state;
    TestRandom random = { 11 };
    WrSessionOptions options = { .pool = NULL };
    WrSession *session = wr_session_new(&options);
    for (int i = 0; i < 3000; i++) {
        WrBrush brush = any_brush(&random);
        WrCall *call;
        WrError err = { "" };
        if (!wr_call_parse(line_of(&brush, &none), true, &call, &err))
            fail_msg("%s: %s", line_of(&brush, &none), err.text);
        WrPainting painting = { .below = NULL };
        if (!wr_painting_begin(session, call, &painting, &err)) fail_msg("%s", err.text);
        assert_same(&brush, &painting.held.brush);
        wr_painting_end(session, &painting);
        wr_call_free(call);
    }
    wr_session_free(session);
}

static void a_brush_that_is_its_preset_says_only_its_name(void **state)
{
    (void)state;
    WrBrush brush = wr_brush_default();
    brush.flow = 0.25;
    brush.aspect = 3;
    WrText line = { 0 };
    WrBrushNames names = { .preset = "wrinkle/groove", .set = "opaque=0.5;slow_tracking=2" };
    wr_brush_line(&line, &brush, &brush, &names);
    assert_string_equal(wr_text_get(&line),
                        " preset=\"wrinkle/groove\" set=\"opaque=0.5;slow_tracking=2\" radius=16 "
                        "hardness=0.5 strength=0.1 mode=raise");
    wr_text_fini(&line);
}

static void names_with_quotes_and_backslashes_come_through(void **state)
{
    (void)state;
    WrBrush brush = wr_brush_default();
    WrBrushNames names = { .tip = "a \"b\" \\ # c.png" };
    WrCall *call;
    WrError err = { "" };
    if (!wr_call_parse(line_of(&brush, &names), true, &call, &err)) fail_msg("%s", err.text);
    assert_string_equal(wr_call_arg(call, "tip")->text, "a \"b\" \\ # c.png");
    wr_call_free(call);
}

static void chance_wants_a_seed(void **state)
{
    (void)state;
    WrBrush brush = wr_brush_default();
    assert_false(wr_brush_chances(&brush));
    brush.jitter_size = 0.1;
    assert_true(wr_brush_chances(&brush));
    brush = wr_brush_default();
    brush.jitter_angle_deg = 5;
    assert_true(wr_brush_chances(&brush));
    brush = wr_brush_default();
    brush.jitter_place = 0.1;
    assert_true(wr_brush_chances(&brush));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_brush_makes_a_short_line),
        cmocka_unit_test(what_is_printed_reads_back_as_the_same_brush),
        cmocka_unit_test(a_brush_that_is_its_preset_says_only_its_name),
        cmocka_unit_test(names_with_quotes_and_backslashes_come_through),
        cmocka_unit_test(chance_wants_a_seed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
