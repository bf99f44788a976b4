/* The brush in commands: presets, tips and symmetry replay bit-identically, changed files are errors, erasing
   restores the content below, strokes drawn in parts equal those drawn at once. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/pool.h"
#include "brush/brush.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"

#include <sys/stat.h>
#include <unistd.h>

static void write_text(const char *path, const char *text)
{
    WrError err;
    if (!wr_file_write(path, text, strlen(text), &err)) fail_msg("%s", err.text);
}

/* A preset of that radius (natural logarithm); more: further members of the file, each after a comma. */
static void write_preset(const char *path, double radius, const char *more)
{
    char text[2048];
    snprintf(text, sizeof text,
             "{\"version\": 3, \"settings\": {"
             "\"radius_logarithmic\": {\"base_value\": %g, \"inputs\": {}},"
             "\"hardness\": {\"base_value\": 0.7, \"inputs\": {}},"
             "\"opaque\": {\"base_value\": 0.8, \"inputs\": {\"random\": [[0, 0], [1, 0.3]]}},"
             "\"radius_by_random\": {\"base_value\": 0.4, \"inputs\": {}}}%s}",
             radius, more);
    write_text(path, text);
}

/* An asymmetric tip. shade: changes its content. */
static void write_tip(const char *path, int shade)
{
    uint8_t grey[12 * 20];
    WrError err;
    for (int i = 0; i < 240; i++) grey[i] = (uint8_t)((i % 12) * 15 + (i / 12) * 4 + shade);
    if (!wr_image_write_pixels(path, 12, 20, 1, WR_PIXEL_U8, true, grey, &err))
        fail_msg("%s", err.text);
}

static int make_files(void **state)
{
    if (enter_folder(state) != 0 || mkdir("sub", 0700) != 0) return -1;
    write_preset("sub/soft.myb", 2, "");
    write_tip("sub/tip.png", 0);
    return 0;
}

static char *hash_of(const char *path)
{
    static char hex[65];
    WrError err;
    if (!wr_sha256_file(path, hex, &err)) fail_msg("%s", err.text);
    return hex;
}

/* ---- replay ---- */

static const char *const strokes[] = {
    "stroke points=0.1,0.2;0.5,0.6,0.5;0.9,0.3 preset=sub/soft.myb seed=5",
    "stroke points=0.1,0.2;0.5,0.6,0.5;0.9,0.3 preset=sub/soft.myb set=\"opaque=0.4;hardness=0.2\"",
    "stroke points=0.1,0.2;0.5,0.6 preset=sub/soft.myb radius=20 mode=smooth strength=1",
    "stroke points=0.9,0.2;0.2,0.6 tip=sub/tip.png radius=14 angle=30 follow=on spacing=0.6",
    "stroke points=0.9,0.2;0.2,0.6 tip=sub/tip.png jitter=0.5,180,0.4 seed=11 flow=0.6",
    "stroke points=0.1,0.1;0.4,0.3 radius=6 mirror=uv radial=3 repeat=2x2 stagger=0.5",
    ("stroke points=0.1,0.1;0.4,0.3,0.2 radius=9 pressure=both aspect=3 angle=20 buildup=on "
     "flow=0.2"),
    "stroke points=0.3,0.3;0.6,0.35 mode=clone source=0.21,-0.17 radius=12",
    "dab 0.7,0.7 tip=sub/tip.png radius=30 strength=0.5",
    "dab 0.2,0.8 preset=sub/soft.myb strength=0.5 radius=25",
    "shape rectangle a=0.2,0.2 b=0.7,0.9 corner=8 tip=sub/tip.png radius=5 spacing=2 flow=0.9",
    "shape ellipse middle=0.5,0.1 radii=0.2,0.3 turn=20 paint=fill mode=to to=0.3 strength=1",
    "shape path points=0.1,0.7;0.3,1.1;0.4,0.4;0.6,0.75 preset=sub/soft.myb seed=9",
    "flood 0.5,0.5 tolerance=0.05 mode=lift to=0.2",
    "ramp cone from=0.2,0.3 to=0.7,0.9 fold=on blend=max high=0.4",
};
#define STROKES (sizeof strokes / sizeof *strokes)

static void what_was_painted_is_painted_again_bit_for_bit_by_its_script(void **state)
{
    (void)state;
    WrError err;
    WrSessionOptions threads = { .pool = wr_pool_new(3) };
    WrSession *s = session_of((const char *[]){ "table 200x144", "grid", NULL });
    must_run(s, "layer add blend=max");
    for (size_t i = 0; i < STROKES; i++) {
        WrHash before = wr_session_hash(s);
        must_run(s, strokes[i]);
        if (wr_hash_equal(before, wr_session_hash(s))) fail_msg("did nothing: %s", strokes[i]);
        WrHash here = wr_session_hash(s);
        must_run(s, "undo");
        assert_true(wr_hash_equal(before, wr_session_hash(s)));
        must_run(s, "redo");
        assert_true(wr_hash_equal(here, wr_session_hash(s)));
    }
    if (!wr_session_save_history(s, "replay.wrinkle", &err)) fail_msg("%s", err.text);
    WrSession *again = wr_session_new(&threads);
    if (!wr_session_run_script(again, "replay.wrinkle", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    wr_session_free(s);
    wr_session_free(again);
    wr_pool_free(threads.pool);
}

static void a_line_learns_the_hashes_of_its_files_and_refuses_others(void **state)
{
    (void)state;
    char line[400];
    WrSession *s = session_of((const char *[]){ "table 64x64", NULL });
    must_run(s, "dab 0.5,0.5 preset=sub/soft.myb tip=sub/tip.png");
    const char *told = wr_session_last_command(s);
    snprintf(line, sizeof line, "preset_sha256=%s", hash_of("sub/soft.myb"));
    assert_non_null(strstr(told, line));
    snprintf(line, sizeof line, "tip_sha256=%s", hash_of("sub/tip.png"));
    assert_non_null(strstr(told, line));
    snprintf(line, sizeof line, "dab 0.5,0.5 preset=sub/soft.myb preset_sha256=%s",
             hash_of("sub/tip.png"));
    must_fail(s, line, "file has changed");
    snprintf(line, sizeof line, "dab 0.5,0.5 tip=sub/tip.png tip_sha256=%s",
             hash_of("sub/soft.myb"));
    must_fail(s, line, "file has changed");
    must_fail(s, "dab 0.5,0.5 preset=sub/none.myb", "sub/none.myb");
    must_fail(s, "dab 0.5,0.5 preset=no/such/name", "no/such/name");
    must_fail(s, "dab 0.5,0.5 preset=sub/tip.png", "sub/tip.png");
    must_fail(s, "dab 0.5,0.5 tip=sub/soft.myb", "soft.myb");
    must_fail(s, "dab 0.5,0.5 set=opaque=0.5", "preset=");
    snprintf(line, sizeof line, "dab 0.5,0.5 tip_sha256=%s", hash_of("sub/tip.png"));
    must_fail(s, line, "tip=");
    must_fail(s, "dab 0.5,0.5 preset=sub/soft.myb set=opaque=1e9", "opaque");
    must_fail(s, "stroke points=0,0 mode=clone", "source=");
    must_fail(s, "stroke points=0,0 repeat=3x1 stagger=0.5", "stagger");
    must_fail(s, "shape ellipse middle=0.5,0.5 radii=0.1,0.1 paint=fill mode=smear", "smear");
    wr_session_free(s);
}

static void a_preset_that_changes_on_the_disk_is_read_again(void **state)
{
    (void)state;
    write_preset("changing.myb", 1.5, "");
    WrSession *s = session_of((const char *[]){ "table 64x64", NULL });
    must_run(s, "dab 0.5,0.5 preset=changing.myb");
    WrHash small = wr_session_hash(s);
    must_run(s, "undo");
    must_run(s, "dab 0.5,0.5 preset=changing.myb");
    assert_true(wr_hash_equal(small, wr_session_hash(s)));
    must_run(s, "undo");
    write_preset("changing.myb", 2.5, "");
    must_run(s, "dab 0.5,0.5 preset=changing.myb");
    WrHash large = wr_session_hash(s);
    assert_false(wr_hash_equal(small, large));
    must_run(s, "undo");
    unlink("changing.myb");
    must_fail(s, "dab 0.5,0.5 preset=changing.myb", "changing.myb");
    wr_session_free(s);
}

/* The session caches 48 files; further ones are read again. */
static void more_presets_than_are_kept_still_paint_what_they_say(void **state)
{
    (void)state;
    enum { MANY = 60 };
    WrHash hashes[MANY];
    WrSession *s = session_of((const char *[]){ "table 64x64", NULL });
    for (int round = 0; round < 2; round++)
        for (int i = 0; i < MANY; i++) {
            char path[32], line[64];
            snprintf(path, sizeof path, "many%d.myb", i);
            snprintf(line, sizeof line, "dab 0.5,0.5 preset=%s", path);
            if (round == 0) write_preset(path, 0.5 + 0.05 * i, "");
            must_run(s, line);
            if (round == 0) hashes[i] = wr_field_hash(wr_document_field(doc(s)));
            else assert_true(wr_hash_equal(hashes[i], wr_field_hash(wr_document_field(doc(s)))));
            must_run(s, "undo");
        }
    assert_false(wr_hash_equal(hashes[0], hashes[MANY - 1]));
    wr_session_free(s);
}

static void a_script_names_presets_and_tips_from_its_own_folder(void **state)
{
    (void)state;
    WrError err;
    write_text("sub/here.wrinkle", "table 64x64\ndab 0.5,0.5 preset=soft.myb tip=tip.png\n");
    WrSession *a = wr_session_new(NULL),
              *b = session_of((const char *[]){
                  "table 64x64", "dab 0.5,0.5 preset=sub/soft.myb tip=sub/tip.png", NULL });
    if (!wr_session_run_script(a, "sub/here.wrinkle", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    if (!wr_session_save_history(a, "there.wrinkle", &err)) fail_msg("%s", err.text);
    wr_session_reset(b);
    if (!wr_session_run_script(b, "there.wrinkle", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    wr_session_free(a);
    wr_session_free(b);
}

static void values_on_the_line_take_the_place_of_the_presets_own(void **state)
{
    (void)state;
    write_preset("own.myb", 2, ", \"wrinkle\": {\"mode\": \"to\", \"strength\": 5, \"to\": 0.75}");
    WrSession *s = session_of((const char *[]){ "table 64x64", NULL });
    must_run(s, "stroke points=0.3,0.5;0.7,0.5 preset=own.myb");
    float low, high;
    wr_field_range(wr_document_field(doc(s)), &low, &high);
    assert_true(low == 0 && high > 0.3f && high <= 0.75f); /* towards 0.75, never beyond */
    must_run(s, "undo");
    must_run(s, "stroke points=0.3,0.5;0.7,0.5 preset=own.myb to=-0.5");
    wr_field_range(wr_document_field(doc(s)), &low, &high);
    assert_true(low < -0.2f && low >= -0.5f && high == 0);
    must_run(s, "undo");
    must_run(s, "stroke points=0.3,0.5;0.7,0.5 preset=own.myb mode=raise");
    wr_field_range(wr_document_field(doc(s)), &low, &high);
    assert_true(high > 1 && high <= 5); /* the preset keeps its strength */
    wr_session_free(s);
}

/* ---- a stroke in pieces ---- */

static void hc75_a_stroke_that_is_pushed_and_worked_in_any_pieces_is_the_line_itself(void **state)
{
    (void)state;
    static const char *const heads[] = {
        "stroke radius=18 strength=0.4", "stroke radius=18 mode=smear",
        "stroke preset=sub/soft.myb radius=12 seed=3",
        "stroke tip=sub/tip.png radius=15 flow=0.5 jitter=0.3,90,0.5 seed=8",
        "stroke radius=10 mirror=u radial=2 mode=smooth"
    };
    TestRandom random = { 75 };
    for (size_t h = 0; h < sizeof heads / sizeof *heads; h++) {
        enum { N = 60 };
        WrSample samples[N];
        WrError err;
        WrSession *s[3];
        for (int i = 0; i < N; i++)
            samples[i] = (WrSample){ .u = 0.1 + 0.013 * i,
                                     .v = 0.5 + 0.3 * sin(0.2 * i),
                                     .pressure = 0.5 + 0.5 * test_random(&random),
                                     .seconds = 0.01 * i };
        for (int k = 0; k < 3; k++) {
            s[k] = session_of((const char *[]){ "table 150x120", "grid", NULL });
            if (!wr_session_stroke_begin(s[k], heads[h], &err)) fail_msg("%s", err.text);
        }
        assert_true(wr_session_stroke_add(s[0], samples, N, &err));
        assert_false(wr_session_stroke_work(s[0], 0));               /* nothing left to draw */
        assert_true(wr_session_stroke_push(s[1], samples, N, &err)); /* all at the end */
        for (int i = 0; i < N;) {
            int n = 1 + (int)(7 * test_random(&random));
            if (n > N - i) n = N - i;
            assert_true(wr_session_stroke_push(s[2], samples + i, n, &err));
            i += n;
            for (int w = (int)(3 * test_random(&random)); w > 0; w--)
                wr_session_stroke_work(s[2], 0);
        }
        for (int k = 0; k < 3; k++) assert_true(wr_session_stroke_end(s[k], &err));
        WrSession *line = session_of(
            (const char *[]){ "table 150x120", "grid", wr_session_last_command(s[0]), NULL });
        for (int k = 0; k < 3; k++) {
            if (!wr_hash_equal(wr_session_hash(line), wr_session_hash(s[k])))
                fail_msg("%s: way %d differs", heads[h], k);
            wr_session_free(s[k]);
        }
        wr_session_free(line);
    }
}

static void pushing_draws_nothing_and_cancelling_leaves_nothing(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = session_of((const char *[]){ "table 400x400", "fill 0.5", NULL });
    WrHash before = wr_session_hash(s);
    const WrSample samples[] = { { .u = 0.2, .v = 0.2, .pressure = 1 },
                                 { .u = 0.6, .v = 0.6, .pressure = 1 } };
    assert_false(wr_session_stroke_push(s, samples, 2, &err));
    assert_false(wr_session_stroke_work(s, 1));
    assert_true(wr_session_stroke_begin(s, "stroke radius=50", &err));
    assert_true(wr_session_stroke_push(s, samples, 2, &err));
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    while (wr_session_stroke_work(s, 0.001)) {
    }
    assert_false(wr_hash_equal(before, wr_session_hash(s)));
    assert_true(wr_session_stroke_push(s, samples, 2, &err));
    wr_session_stroke_cancel(s);
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    assert_int_equal(wr_session_history_count(s), 2);
    wr_session_free(s);
}

static void a_step_costs_the_tiles_that_it_touched(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 4096x4096", "layer add blend=max", NULL });
    static const struct {
        const char *line;
        int tiles; /* limit of tiles of heights and of coverage */
    } steps[] = { { "dab 0.508,0.508 radius=10", 2 * 1 },
                  { "dab 0.5,0.5 radius=10 tip=sub/tip.png", 2 * 4 },
                  { "stroke points=0.2,0.2;0.2,0.2156 radius=20 mode=erase", 2 * 6 },
                  { "stroke points=0.2,0.2;0.23,0.2 preset=sub/soft.myb", 2 * 12 },
                  { "shape rectangle a=0.1,0.1 b=0.131,0.131 paint=fill", 2 * 16 },
                  { "shape ellipse middle=0.5,0.5 radii=0.02,0.02 radius=4", 2 * 24 } };
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        must_run(s, steps[i].line);
        size_t bytes = wr_session_history_step_bytes(s, wr_session_history_position(s) - 1);
        if (bytes > (size_t)steps[i].tiles * WR_TILE * WR_TILE * 4 + 8000)
            fail_msg("%s: %zu bytes", steps[i].line, bytes);
    }
    wr_session_free(s);
}

/* ---- erasing ---- */

static const char *const ground_lines[] = { "table 96x80",
                                            "grid cells=3x2 width=9 low=0.2 high=0.8",
                                            "dab 0.3,0.4 radius=30 strength=0.5", NULL };
/* a layer, painted at places above and below the content under it */
static const char *const paint_lines[] = { "stroke points=0.1,0.2;0.9,0.7 radius=15 strength=1.2",
                                           "stroke points=0.2,0.8;0.8,0.3 radius=12 strength=0.6" };

static WrSession *painted_layer(const char *blend, bool paint)
{
    char line[64];
    WrSession *s = session_of(ground_lines);
    snprintf(line, sizeof line, "layer add top blend=%s radius=0.1", blend);
    must_run(s, line);
    for (int i = 0; paint && i < 2; i++) must_run(s, paint_lines[i]);
    return s;
}

/* Erase everything with strength p; both composites, before and after, against the one without the layer. */
static void check_erased(const char *blend, double part)
{
    char line[96];
    WrSession *s = painted_layer(blend, true), *bare = session_of(ground_lines);
    WrField *full = wr_field_share(wr_document_field(doc(s)));
    snprintf(line, sizeof line, "dab 0.5,0.5 radius=1000 hardness=1 mode=erase opacity=%g", part);
    must_run(s, line);
    int changed = 0;
    for (int j = 0; j < 80; j++)
        for (int i = 0; i < 96; i++) {
            double was = wr_field_get(full, i, j), is = f_at(s, i, j), below = f_at(bare, i, j);
            assert_near(is, was + part * (below - was), part == 1 ? 0 : 1e-6);
            changed += fabs(is - was) > 0.01;
        }
    assert_true(changed > 100);
    wr_field_free(full);
    wr_session_free(s);
    wr_session_free(bare);
}

static void erasing_leads_from_every_blend_straight_back_to_what_lies_below(void **state)
{
    (void)state;
    static const char *const straight[] = { "add",        "subtract", "max",      "min",
                                            "smooth-max", "replace",  "multiply", "smooth-min" };
    for (size_t i = 0; i < sizeof straight / sizeof *straight; i++) {
        check_erased(straight[i], 1);
        check_erased(straight[i], 0.25);
    }
}

static void erasing_a_mixed_layer_leads_to_the_composite_below_it(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) { /* a layer in mode mix acts everywhere, painted or not */
        WrSession *s = painted_layer("mix", true), *bare = session_of(ground_lines);
        WrField *full = wr_field_share(wr_document_field(doc(s)));
        double part = k ? 1 : 0.3;
        char line[96];
        snprintf(line, sizeof line, "dab 0.5,0.5 radius=1000 hardness=1 mode=erase opacity=%g",
                 part);
        must_run(s, line);
        for (int j = 0; j < 80; j++)
            for (int i = 0; i < 96; i++) {
                double was = wr_field_get(full, i, j), below = f_at(bare, i, j);
                assert_near(f_at(s, i, j), was + part * (below - was), 1e-6);
            }
        wr_field_free(full);
        wr_session_free(s);
        wr_session_free(bare);
    }
}

static void what_was_erased_wholly_does_not_come_back_under_new_paint(void **state)
{
    (void)state;
    static const char *const blends[] = { "add", "max", "replace", "smooth-max" };
    for (size_t k = 0; k < sizeof blends / sizeof *blends; k++) {
        WrSession *s = painted_layer(blends[k], true), *fresh = painted_layer(blends[k], false);
        must_run(s, "dab 0.5,0.5 radius=1000 hardness=1 mode=erase");
        must_run(s, "dab 0.4,0.4 radius=20 strength=0.9");
        must_run(fresh, "dab 0.4,0.4 radius=20 strength=0.9");
        assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(fresh)));
        wr_session_free(s);
        wr_session_free(fresh);
    }
}

static void erasing_the_lowest_layer_leads_to_the_ground(void **state)
{
    (void)state;
    WrSession *s = session_of(ground_lines);
    must_run(s, "dab 0.5,0.5 radius=20 hardness=1 mode=erase");
    assert_true(f_at(s, 48, 40) == 0);
    assert_true(f_at(s, 0, 0) != 0);
    assert_null(doc(s)->layers[0].cover);
    wr_session_free(s);
}

/* A copy of the lowest layer has coverage everywhere, so that it can be erased. */
static void a_layer_without_cover_can_be_erased_too(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = session_of(ground_lines);
    must_run(s, "layer duplicate 1");
    must_run(s, "layer set 2 blend=replace");
    must_run(s, "adjust add amount=1");
    assert_null(doc(s)->layers[1].cover);
    int steps = wr_session_history_count(s);
    WrHash before = wr_session_hash(s);
    assert_true(wr_session_stroke_begin(s, "stroke mode=erase", &err));
    assert_true(wr_session_stroke_end(s, &err)); /* nothing drawn, no effect */
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    assert_int_equal(wr_session_history_count(s), steps);
    must_run(s, "dab 0.5,0.5 radius=20 hardness=1 mode=erase");
    WrSession *bare = session_of(ground_lines);
    assert_true(f_at(s, 48, 40) == f_at(bare, 48, 40));
    assert_near(f_at(s, 2, 2), f_at(bare, 2, 2) + 1, 1e-6);
    must_run(s, "undo");
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
    wr_session_free(bare);
}

/* ---- symmetry ---- */

static void copies_of_a_repeat_are_the_table_rolled_bit_for_bit(void **state)
{
    (void)state;
    WrSession *s = session_of(
        (const char *[]){ "table 128x96",
                          "stroke points=0.1,0.1;0.3,0.42;0.2,0.3,0.5 radius=7 strength=0.3 "
                          "repeat=4x2 stagger=0.5 mode=raise",
                          NULL });
    int touched = 0;
    for (int j = 0; j < 96; j++)
        for (int i = 0; i < 128; i++) {
            /* a column is 32 to the right and half a row of 48 higher */
            assert_true(f_at(s, i, j) == f_at(s, (i + 32) % 128, (j + 96 - 24) % 96));
            assert_true(f_at(s, i, j) == f_at(s, i, (j + 48) % 96));
            touched += f_at(s, i, j) != 0;
        }
    assert_true(touched > 1000);
    wr_session_free(s);
}

static void mirrors_and_turns_make_the_picture_symmetric(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){
        "table 128x128",
        "stroke points=0.1,0.2;0.3,0.42;0.2,0.3,0.5 radius=7 strength=0.3 "
        "mirror=u radial=4 tip=sub/tip.png",
        "shape polygon points=0.6,0.6;0.9,0.65;0.7,0.8 paint=fill mirror=u radial=4 strength=0.2",
        NULL });
    int touched = 0;
    for (int j = 0; j < 128; j++)
        for (int i = 0; i < 128; i++) {
            assert_near(f_at(s, i, j), f_at(s, 127 - i, j), 1e-5);
            assert_near(f_at(s, i, j), f_at(s, j, 127 - i), 1e-5);
            touched += f_at(s, i, j) != 0;
        }
    assert_true(touched > 1000);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_painted_is_painted_again_bit_for_bit_by_its_script),
        cmocka_unit_test(a_line_learns_the_hashes_of_its_files_and_refuses_others),
        cmocka_unit_test(a_preset_that_changes_on_the_disk_is_read_again),
        cmocka_unit_test(more_presets_than_are_kept_still_paint_what_they_say),
        cmocka_unit_test(a_script_names_presets_and_tips_from_its_own_folder),
        cmocka_unit_test(values_on_the_line_take_the_place_of_the_presets_own),
        cmocka_unit_test(hc75_a_stroke_that_is_pushed_and_worked_in_any_pieces_is_the_line_itself),
        cmocka_unit_test(pushing_draws_nothing_and_cancelling_leaves_nothing),
        cmocka_unit_test(a_step_costs_the_tiles_that_it_touched),
        cmocka_unit_test(erasing_leads_from_every_blend_straight_back_to_what_lies_below),
        cmocka_unit_test(erasing_a_mixed_layer_leads_to_the_composite_below_it),
        cmocka_unit_test(what_was_erased_wholly_does_not_come_back_under_new_paint),
        cmocka_unit_test(erasing_the_lowest_layer_leads_to_the_ground),
        cmocka_unit_test(a_layer_without_cover_can_be_erased_too),
        cmocka_unit_test(copies_of_a_repeat_are_the_table_rolled_bit_for_bit),
        cmocka_unit_test(mirrors_and_turns_make_the_picture_symmetric),
    };
    return cmocka_run_group_tests(tests, make_files, remove_folder);
}
