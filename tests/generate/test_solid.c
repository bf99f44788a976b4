/* The family of solids: positions, resulting heights, and refusals. */
#include "test.h"
#include "generate_help.h"

#include "base/pool.h"
#include "generate/zbuffer.h"
#include "surface/surface.h"
#include "system/clock.h"

#include <unistd.h>

typedef struct Asked {
    const WrGenerator *row;
    WrParamValue values[WR_GENERATOR_PARAMS];
} Asked;

/* A solid by its name with parameters: name, value, ..., NULL. */
static Asked ask(const char *name, const Setting *settings)
{
    Asked asked = { .row = wr_generator_find("solid", name) };
    assert_non_null(asked.row);
    usual_values(asked.row, asked.values);
    for (; settings && settings->name; settings++)
        value_of(asked.row, asked.values, settings->name)->number[0] = settings->value;
    return asked;
}

static void set(Asked *asked, const char *name, double x, double y, double z)
{
    double *number = value_of(asked->row, asked->values, name)->number;
    number[0] = x;
    number[1] = y;
    number[2] = z;
}

static WrRelief make(const Asked *asked, const WrField *like, WrPool *pool)
{
    WrRelief relief = { 0 };
    WrError err = { "" };
    WrGenerateJob job = { .like = like, .pool = pool };
    if (!wr_generator_make(asked->row, asked->values, &job, &relief, &err))
        fail_msg("%s", err.text);
    return relief;
}

static void refuse(const Asked *asked, const char *words)
{
    WrField *like = table_of(32, 32);
    WrRelief relief = { 0 };
    WrError err = { "" };
    WrGenerateJob job = { .like = like };
    assert_false(wr_generator_make(asked->row, asked->values, &job, &relief, &err));
    if (!strstr(err.text, words)) fail_msg("\"%s\" has not \"%s\"", err.text, words);
    assert_null(relief.heights);
    wr_field_free(like);
}

/* ---- heights ---- */

/* height=1: a half sphere rises to 1 for any radius; sunk by half of it, to a half. */
static void a_rivet_rises_to_its_height_less_what_is_sunk(void **state)
{
    (void)state;
    WrField *like = table_of(129, 129);
    for (int sunk = 0; sunk < 2; sunk++) {
        const Setting settings[] = { { "radius", 40 }, { "sink", sunk ? 20 : 0 }, { NULL, 0 } };
        Asked asked = ask("sphere", settings);
        WrRelief relief = make(&asked, like, NULL);
        for (int i = 0; i < 129; i++) {
            double d = i - 64, z = sqrt(fmax(0.0, 1600.0 - d * d)) - (sunk ? 20.0 : 0.0);
            if (z < 0.01) continue;
            assert_near((double)wr_field_get(relief.heights, i, 64), z / 40.0, 1e-6);
        }
        wr_relief_fini(&relief);
    }
    wr_field_free(like);
}

static void every_closed_form_rises_to_its_height_in_any_pose(void **state)
{
    (void)state;
    static const char *const names[] = { "sphere", "ellipsoid", "box",    "cylinder",
                                         "cone",   "torus",     "capsule" };
    WrField *like = table_of(512, 512);
    for (int k = 0; k < 7; k++)
        for (int pose = 0; pose < 3; pose++) {
            float low, high; /* tips may fall between texels */
            Asked asked = ask(names[k], NULL);
            set(&asked, "rotate", pose * 37.0, pose * 61.0, 20.0);
            set(&asked, "height", 3.0, 0.0, 0.0);
            WrRelief relief = make(&asked, like, NULL);
            wr_field_range(relief.heights, &low, &high);
            if (high > 3.0001f || high < 2.75f) fail_msg("%s: %g", names[k], (double)high);
            wr_relief_fini(&relief);
        }
    wr_field_free(like);
}

/* ---- places ---- */

static void hc79_a_moved_solid_is_a_rolled_one_over_edges_bit_for_bit(void **state)
{
    (void)state;
    static const char *const names[] = { "sphere", "box", "torus", "cone", "surface" };
    WrField *like = table_of(128, 64);
    for (int k = 0; k < 5; k++) {
        const Setting settings[] = { { "across", 3 },    { "rows", 2 },  { "jitter", 9 },
                                     { "turn", 50 },     { "tilt", 20 }, { "vary", 0.3 },
                                     { "stagger", 0.5 }, { NULL, 0 } };
        Asked asked = ask(names[k], settings);
        if (k == 4) set(&asked, "size", 30, 0, 0);
        WrRelief still = make(&asked, like, NULL);
        set(&asked, "at", 0.5 + 45.0 / 128.0, 0.5 - 19.0 / 64.0, 0);
        WrRelief moved = make(&asked, like, NULL);
        if (!is_rolled(still.heights, moved.heights, 45, -19) ||
            !is_rolled(still.cover, moved.cover, 45, -19))
            fail_msg("%s: a moved one is not rolled", names[k]);
        wr_relief_fini(&still);
        wr_relief_fini(&moved);
    }
    wr_field_free(like);
}

/* 100 x 100 rivets over a table: each cell equals the first one, bit for bit. */
static void ten_thousand_rivets_are_alike_and_quickly_there(void **state)
{
    (void)state;
    WrField *like = table_of(1600, 1600);
    const Setting settings[] = { { "across", 100 }, { "rows", 100 }, { "radius", 6 }, { NULL, 0 } };
    Asked asked = ask("sphere", settings);
    WrRelief first = { 0 };
    double start = wr_clock_seconds();
    for (int threads = 1; threads <= 3; threads++) {
        WrPool *pool = wr_pool_new(threads);
        WrRelief again = make(&asked, like, pool);
        if (first.heights) {
            assert_true(wr_hash_equal(wr_field_hash(first.heights), wr_field_hash(again.heights)));
            wr_relief_fini(&again);
        } else {
            first = again;
        }
        wr_pool_free(pool);
    }
    /* a tenth of a second each; more with sanitizers */
    assert_true(wr_clock_seconds() - start < 20.0);
    assert_true(is_rolled(first.heights, first.heights, 16, 0));
    assert_true(is_rolled(first.heights, first.heights, 0, 16 * 7));
    assert_false(is_rolled(first.heights, first.heights, 8, 0));
    wr_relief_fini(&first);
    wr_field_free(like);
}

static void the_seed_alone_decides_about_accidents(void **state)
{
    (void)state;
    WrField *like = table_of(200, 200);
    const Setting settings[] = { { "across", 4 }, { "rows", 4 },   { "radius", 15 },
                                 { "jitter", 8 }, { "vary", 0.5 }, { NULL, 0 } };
    Asked asked = ask("sphere", settings);
    WrRelief a = make(&asked, like, NULL), b = make(&asked, like, NULL);
    set(&asked, "seed", 2, 0, 0);
    WrRelief c = make(&asked, like, NULL);
    assert_true(wr_hash_equal(wr_field_hash(a.heights), wr_field_hash(b.heights)));
    assert_false(wr_hash_equal(wr_field_hash(a.heights), wr_field_hash(c.heights)));
    wr_relief_fini(&a);
    wr_relief_fini(&b);
    wr_relief_fini(&c);
    wr_field_free(like);
}

/* ---- nets ---- */

/* A sphere surface against the formula: FINE of solid_generators.c along the normal, and the rounding of corners. */
static void a_surface_is_what_its_formula_says_within_a_fiftieth_of_a_texel(void **state)
{
    (void)state;
    WrField *like = wr_field_new(256, 256, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, NULL);
    Asked asked = ask("surface", NULL);
    value_of(asked.row, asked.values, "shape")->text = "sphere";
    set(&asked, "size", 200, 0, 0);
    set(&asked, "height", 200, 0, 0);
    set(&asked, "rotate", 30, 50, 70);
    WrRelief relief = make(&asked, like, NULL);
    for (int j = 0; j < 256; j++)
        for (int i = 0; i < 256; i++) {
            double d = hypot(i - 127.5, j - 127.5);
            if (d < 98.5) assert_true(wr_field_get(relief.cover, i, j) == 1.0f);
            if (d > 101) assert_true(wr_field_get(relief.cover, i, j) == 0.0f);
            if (d < 80.0) /* cos(slope) over 0.6 */
                assert_near((double)wr_field_get(relief.heights, i, j),
                            100.0 + sqrt(10000.0 - d * d), 2 * 0.02 / 0.6 + 0.02);
        }
    wr_relief_fini(&relief);
    wr_field_free(like);
}

static void every_surface_can_be_seen_from_above(void **state)
{
    (void)state;
    WrField *like = table_of(64, 64);
    for (int k = 0; k < WR_SURFACE_COUNT; k++) {
        Asked asked = ask("surface", NULL);
        float low, high;
        value_of(asked.row, asked.values, "shape")->text = wr_surfaces[k]->name;
        set(&asked, "size", 40, 0, 0);
        set(&asked, "rotate", 20, 30, 0);
        WrRelief relief = make(&asked, like, NULL);
        wr_field_range(relief.heights, &low, &high);
        if (!(high > 0.8f && high <= 1.0001f))
            fail_msg("%s: %g", wr_surfaces[k]->name, (double)high);
        wr_relief_fini(&relief);
    }
    wr_field_free(like);
}

/* Surfaces with text parameters: a cone from a profile equals the cone, a flat disc from formulas is flat. */
static void surfaces_of_words_can_be_seen_from_above(void **state)
{
    (void)state;
    WrField *like = table_of(64, 64);
    static const char *const same[2][2] = {
        { "cone R=0.5 H=1", "revolution profile=0.5,-0.5;0,0.5;0,0.5" },
        { "sphere R=2", "formula  x=2*cos(2*pi*u)*cos(pi*(v-0.5)) y=2*sin(2*pi*u)*cos(pi*(v-0.5)) "
                        "z=2*sin(pi*(v-0.5))" }
    };
    for (int k = 0; k < 2; k++) {
        WrRelief relief[2];
        for (int i = 0; i < 2; i++) {
            Asked asked = ask("surface", NULL);
            value_of(asked.row, asked.values, "shape")->text = same[k][i];
            set(&asked, "size", 40, 0, 0);
            relief[i] = make(&asked, like, NULL);
        }
        for (int t = 0; t < 64 * 64; t++)
            assert_near((double)wr_field_get(relief[0].heights, t % 64, t / 64),
                        (double)wr_field_get(relief[1].heights, t % 64, t / 64), 2e-3);
        for (int i = 0; i < 2; i++) wr_relief_fini(&relief[i]);
    }
    static const char *const wrong[][2] = { { "revolution profile=1,0", "2 to 65" },
                                            { "formula x=1+ y=u", "column 3" },
                                            { "revolution profil=1,0", "NAME=VALUE" },
                                            { "formula z=sqrt(u)", "no slope" } };
    for (int k = 0; k < 4; k++) {
        Asked asked = ask("surface", NULL);
        value_of(asked.row, asked.values, "shape")->text = wrong[k][0];
        refuse(&asked, wrong[k][1]);
    }
    wr_field_free(like);
}

/* A slanted square in a file: a plane, fitted by its bounding box. */
static void a_mesh_is_fitted_to_its_size_and_stands_on_the_ground(void **state)
{
    (void)state;
    static const char obj[] = "v 10 10 5\nv 14 10 5\nv 14 14 7\nv 10 14 7\nf 1 2 3 4\n";
    char path[] = "/tmp/wrinkle-solid-XXXXXX.obj";
    int fd = mkstemps(path, 4);
    assert_int_equal(write(fd, obj, sizeof obj - 1), (ssize_t)sizeof obj - 1);
    close(fd);
    WrField *like = wr_field_new(64, 64, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, NULL);
    Asked asked = ask("mesh", NULL);
    value_of(asked.row, asked.values, "file")->text = path;
    set(&asked, "size", 40, 0, 0);
    set(&asked, "height", 8, 0, 0);
    WrRelief relief = make(&asked, like, NULL);
    for (int j = 13; j <= 50; j++)
        for (int i = 13; i <= 50; i++) {
            double up = (51.5 - j) / 40.0; /* from the lower edge to the upper one */
            assert_near((double)wr_field_get(relief.heights, i, j), 8.0 * up, 1e-4);
            assert_true(wr_field_get(relief.cover, i, j) == 1.0f);
        }
    assert_true(wr_field_get(relief.cover, 10, 30) == 0.0f);
    wr_relief_fini(&relief);
    wr_field_free(like);
    unlink(path);
}

/* ---- letters ---- */

/* A solid block in the built-in font would suffice; any text must be level on top, with sloping sides. */
static void letters_are_level_on_top_and_bevelled_at_their_edges(void **state)
{
    (void)state;
    WrField *like = table_of(256, 128);
    const Setting settings[] = { { "size", 96 },   { "depth", 10 },  { "bevel", 2 },
                                 { "profile", 1 }, { "height", 10 }, { NULL, 0 } };
    Asked asked = ask("letters", settings);
    value_of(asked.row, asked.values, "text")->text = "HE";
    WrRelief relief = make(&asked, like, NULL);
    int top = 0, flank = 0, bare = 0;
    for (int j = 0; j < 128; j++)
        for (int i = 0; i < 256; i++) {
            float h = wr_field_get(relief.heights, i, j);
            float cover = wr_field_get(relief.cover, i, j);
            bare += cover == 0.0f;
            if (cover < 1.0f) continue;
            assert_true(h >= 8.0f - 1e-5f && h <= 10.0f + 1e-5f);
            if (h > 10.0f - 1e-5f) top++;
            else flank++;
        }
    assert_true(top > 200 && flank > 200 && bare > 8000);
    wr_relief_fini(&relief);
    wr_field_free(like);
}

/* Letters are symmetric under half a turn if the text is: 'H' about its centre. */
static void letters_turned_by_half_a_turn_are_upside_down(void **state)
{
    (void)state;
    WrField *like = wr_field_new(127, 127, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, NULL);
    Asked asked = ask("letters", NULL);
    value_of(asked.row, asked.values, "text")->text = "L";
    WrRelief a = make(&asked, like, NULL);
    set(&asked, "rotate", 0, 0, 180);
    WrRelief b = make(&asked, like, NULL);
    for (int j = 0; j < 127; j++)
        for (int i = 0; i < 127; i++) {
            if (wr_field_get(a.cover, i, j) < 1.0f ||
                wr_field_get(b.cover, 126 - i, 126 - j) < 1.0f)
                continue;
            assert_near((double)wr_field_get(a.heights, i, j),
                        (double)wr_field_get(b.heights, 126 - i, 126 - j), 1e-5);
        }
    wr_relief_fini(&a);
    wr_relief_fini(&b);
    wr_field_free(like);
}

/* ---- errors ---- */

static void impossible_solids_are_refused_in_words(void **state)
{
    (void)state;
    const Setting thick[] = { { "radius", 10 }, { "tube", 10 }, { NULL, 0 } };
    const Setting short_one[] = { { "radius", 10 }, { "length", 19 }, { NULL, 0 } };
    Asked asked = ask("torus", thick);
    refuse(&asked, "tube=10: must be less than");
    asked = ask("capsule", short_one);
    refuse(&asked, "length=19: must be at least");
    asked = ask("surface", NULL);
    static const char *const shapes[][2] = { { "", "is empty" },
                                             { "teapot", "is not a surface" },
                                             { "torus R", "must be NAME=VALUE" },
                                             { "torus R=x", "must be 1 numbers" },
                                             { "torus R=1,2", "must be 1 numbers" },
                                             { "torus R=-1", "R" } };
    for (int i = 0; i < 6; i++) {
        value_of(asked.row, asked.values, "shape")->text = shapes[i][0];
        refuse(&asked, shapes[i][1]);
    }
    asked = ask("letters", NULL);
    value_of(asked.row, asked.values, "text")->text = " ";
    refuse(&asked, "the text has no visible letters");
    asked = ask("mesh", NULL);
    value_of(asked.row, asked.values, "file")->text = "/nowhere/a.obj";
    refuse(&asked, "/nowhere/a.obj");
    asked = ask("surface", NULL);
    set(&asked, "across", 1024, 0, 0);
    set(&asked, "rows", 1024, 0, 0);
    refuse(&asked, "triangles together");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rivet_rises_to_its_height_less_what_is_sunk),
        cmocka_unit_test(every_closed_form_rises_to_its_height_in_any_pose),
        cmocka_unit_test(hc79_a_moved_solid_is_a_rolled_one_over_edges_bit_for_bit),
        cmocka_unit_test(ten_thousand_rivets_are_alike_and_quickly_there),
        cmocka_unit_test(the_seed_alone_decides_about_accidents),
        cmocka_unit_test(a_surface_is_what_its_formula_says_within_a_fiftieth_of_a_texel),
        cmocka_unit_test(every_surface_can_be_seen_from_above),
        cmocka_unit_test(surfaces_of_words_can_be_seen_from_above),
        cmocka_unit_test(a_mesh_is_fitted_to_its_size_and_stands_on_the_ground),
        cmocka_unit_test(letters_are_level_on_top_and_bevelled_at_their_edges),
        cmocka_unit_test(letters_turned_by_half_a_turn_are_upside_down),
        cmocka_unit_test(impossible_solids_are_refused_in_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
