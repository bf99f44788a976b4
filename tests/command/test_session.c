/* Sessions: every edit and scene command, failures that change nothing, strokes in progress. */
#include "test.h"
#include "field/scheme_list.h"
#include "session_help.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/brush.h"
#include "command/command_line.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "scene/scene.h"

static const WrField *field_of(const WrSession *session)
{
    return wr_document_field(wr_session_document(session));
}

static const WrScene *scene_of(const WrSession *session)
{
    return wr_session_document(session)->scene;
}

static char *scene_text(const WrSession *session)
{
    WrText text = { 0 };
    wr_session_scene_text(session, &text);
    char *kept = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return kept;
}

/* ---- edits ---- */

static void table_sets_size_and_wrap_and_starts_at_zero(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "fill 3", "table 7x5 wrap=clamp-v", NULL });
    const WrField *field = field_of(s);
    assert_int_equal(wr_field_width(field), 7);
    assert_int_equal(wr_field_height(field), 5);
    assert_int_equal(wr_field_wrap_u(field), WR_WRAP_PERIODIC);
    assert_int_equal(wr_field_wrap_v(field), WR_WRAP_CLAMP);
    assert_true(wr_field_get(field, 6, 4) == 0);
    must_run(s, "table 7x5 wrap=clamp-u");
    assert_int_equal(wr_field_wrap_u(field_of(s)), WR_WRAP_CLAMP);
    assert_int_equal(wr_field_wrap_v(field_of(s)), WR_WRAP_PERIODIC);
    must_run(s, "fill -0.25");
    assert_true(wr_field_get(field_of(s), 3, 2) == -0.25f);
    wr_session_free(s);
}

static void grid_of_whole_cells_covers_the_texels_that_counting_gives(void **state)
{
    (void)state;
    WrSession *s = session_of(
        (const char *[]){ "table 128x64", "grid cells=8x4 width=6 low=-1 high=2", NULL });
    /* 8 columns of lines and 4 rows of lines, each 6 texels wide */
    int expected = 128 * 64 - (128 - 48) * (64 - 24), high = 0;
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 128; i++) {
            float f = wr_field_get(field_of(s), i, j);
            assert_true(f == 2 || f == -1);
            high += f == 2;
        }
    assert_int_equal(high, expected);
    wr_session_free(s);
}

static void grid_is_half_open_at_a_line_of_odd_width(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 16x16", "grid cells=4x1 width=3", NULL });
    /* Row 8 is far from the only boundary along v. Offsets from a boundary are -1.5, -0.5, 0.5, 1.5: the first three
       are on the line. */
    for (int i = 0; i < 16; i++) {
        bool on = i % 4 == 0 || i % 4 == 2 || i % 4 == 3;
        assert_true(wr_field_get(field_of(s), i, 8) == (on ? 1 : 0));
    }
    assert_true(wr_field_get(field_of(s), 1, 0) == 1 && wr_field_get(field_of(s), 1, 1) == 0);
    assert_true(wr_field_get(field_of(s), 1, 14) == 1 && wr_field_get(field_of(s), 1, 13) == 0);
    wr_session_free(s);
}

static void grid_whose_cells_do_not_divide_the_table_agrees_with_distances(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 100x70", "grid cells=7x3 width=2.5", NULL });
    for (int j = 0; j < 70; j++)
        for (int i = 0; i < 100; i++) {
            bool on = false;
            for (int k = 0; k <= 7; k++) on |= fabs(i + 0.5 - k * 100 / 7.0) < 1.25;
            for (int k = 0; k <= 3; k++) on |= fabs(j + 0.5 - k * 70 / 3.0) < 1.25;
            assert_true(wr_field_get(field_of(s), i, j) == (on ? 1 : 0));
        }
    must_run(s, "grid width=0");
    float low, high;
    wr_field_range(field_of(s), &low, &high);
    assert_true(low == 0 && high == 0);
    wr_session_free(s);
}

static void dab_changes_its_centre_by_exactly_the_strength(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){
        "table 64x64", "fill 1", "dab 0.5078125,0.4921875 radius=9 strength=0.5", NULL });
    /* u = 32.5/64 and v = 1 - 32.5/64 is the centre of texel (32, 32) */
    assert_true(wr_field_get(field_of(s), 32, 32) == 1.5f);
    assert_true(wr_field_get(field_of(s), 32 + 10, 32) == 1);
    must_run(s, "dab 0.5078125,0.4921875 radius=9 strength=0.25 mode=lower");
    assert_true(wr_field_get(field_of(s), 32, 32) == 1.25f);
    must_run(s, "dab 0.5078125,0.4921875 radius=9 strength=100 mode=to to=-3");
    assert_true(wr_field_get(field_of(s), 32, 32) == -3);
    wr_session_free(s);
}

static void a_stroke_of_one_point_is_a_dab(void **state)
{
    (void)state;
    WrSession *a = session_of((const char *[]){ "dab 0.3,0.6 radius=20", NULL });
    WrSession *b = session_of((const char *[]){ "stroke points=0.3,0.6 radius=20", NULL });
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    wr_session_free(a);
    wr_session_free(b);
}

/* ---- the scene ---- */

static void only_what_is_given_changes(void **state)
{
    (void)state;
    WrSession *s =
        session_of((const char *[]){ "bump mode=exact scheme=catmull height=0.25", "bump height=-2",
                                     "material shininess=12 gate=off", "material ambient=0.5",
                                     "dials samples=7", "dials aa=supersample", NULL });
    const WrScene *scene = scene_of(s);
    assert_int_equal(scene->bump, WR_BUMP_EXACT);
    assert_int_equal(scene->scheme, WR_SCHEME_CATMULL);
    assert_true(scene->height == -2);
    assert_true(scene->material.shininess == 12 && scene->material.ambient == 0.5);
    assert_false(scene->material.gate);
    assert_int_equal(scene->dials.samples, 7);
    assert_int_equal(scene->dials.aa, WR_AA_SUPERSAMPLE);
    assert_int_equal(scene->dials.arithmetic, WR_ARITHMETIC_EXACT);
    wr_session_free(s);
}

static void surface_takes_defaults_for_what_is_left_out(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){
        "rotate 1,2,3", "bump height=0.7", "surface torus R=3 r=0.5", "surface torus R=5", NULL });
    WrShape shape;
    wr_shape_default(WR_SURFACE_torus, &shape);
    shape.value[wr_surface_param_offset(WR_SURFACE_torus, "R")] = 5;
    assert_memory_equal(&scene_of(s)->shape, &shape, sizeof shape);
    assert_true(scene_of(s)->height == 0.7 && scene_of(s)->rotate_deg.z == 3);
    wr_session_free(s);
}

static void bezier_points_come_u_index_fastest(void **state)
{
    (void)state;
    WrText line = { 0 };
    wr_text_add(&line, "surface bezier points=");
    for (int k = 0; k < 16; k++) wr_text_addf(&line, "%s%d,%d,0", k ? ";" : "", k % 4, k / 4);
    WrSession *s = session_of((const char *[]){ wr_text_get(&line), NULL });
    /* Evenly spaced control points: P(u,v) = (3u, 3v, 0). */
    WrSurfacePoint p;
    wr_surface_at(&scene_of(s)->shape, 0, 0.25, 0.75, &p);
    assert_near(p.p.x, 0.75, 1e-12);
    assert_near(p.p.y, 2.25, 1e-12);
    wr_text_fini(&line);
    wr_session_free(s);
}

static void the_first_light_takes_the_default_ones_place(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "light point at=1,2,3 strength=4", NULL });
    assert_int_equal(scene_of(s)->light_count, 1);
    must_run(s, "light directional to=0,0,2 colour=1,0.5,0");
    assert_int_equal(scene_of(s)->light_count, 2);
    must_run(s, "light point at=9,9,9 index=2");
    assert_int_equal(scene_of(s)->light_count, 2);
    assert_int_equal(scene_of(s)->lights[1].kind, WR_LIGHT_POINT);
    assert_true(scene_of(s)->lights[1].colour.y == 1 && scene_of(s)->lights[0].strength == 4);
    assert_false(wr_session_run(s, "light point at=9,9,9 index=3", NULL));
    must_run(s, "light clear");
    assert_int_equal(scene_of(s)->light_count, 0);
    must_run(s, "light point at=9,9,9");
    assert_int_equal(scene_of(s)->light_count, 1);
    for (int i = 1; i < 256; i++) must_run(s, "light point at=1,1,1");
    assert_false(wr_session_run(s, "light point at=1,1,1", NULL));
    wr_session_free(s);
}

static void the_camera_fits_until_an_eye_is_given(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "camera perspective fov=20", NULL });
    assert_true(scene_of(s)->camera.fit && scene_of(s)->camera.fov_deg == 20);
    must_run(s, "camera orthographic eye=1,2,3 size=4");
    assert_true(!scene_of(s)->camera.fit && scene_of(s)->camera.orthographic);
    must_run(s, "camera perspective target=0,1,0");
    assert_true(!scene_of(s)->camera.fit && scene_of(s)->camera.eye.z == 3);
    must_run(s, "camera perspective fit=on");
    assert_true(scene_of(s)->camera.fit && scene_of(s)->camera.fov_deg == 20);
    assert_true(scene_of(s)->camera.size == 4);
    wr_session_free(s);
}

static void analytic_terms_arrive_with_their_phases(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "bump height=1 mode=blinn",
                                                "analytic fourier terms=1,0,2,-90,0;0,0,3", NULL });
    /* 2 cos(2 pi u - 90 deg) + 3 = 2 sin(2 pi u) + 3 */
    double f, fu;
    wr_scene_height(scene_of(s), field_of(s), 0.25, 0.3, &f, &fu, NULL);
    assert_near(f, 5, 1e-12);
    assert_near(fu, 0, 1e-12);
    must_run(s, "analytic poly c=2,1,0.5");
    wr_scene_height(scene_of(s), field_of(s), 0.5, 0.5, &f, &fu, NULL); /* 0.5 u^2 v */
    assert_near(f, 0.0625, 1e-15);
    assert_near(fu, 0.25, 1e-15);
    must_run(s, "analytic off");
    wr_scene_height(scene_of(s), field_of(s), 0.5, 0.5, &f, NULL, NULL);
    assert_true(f == 0);
    wr_session_free(s);
}

static void last_note(void *ctx, const char *text)
{
    snprintf(ctx, 512, "%s", text);
}

static void hc41_a_seam_on_a_closed_surface_is_noted(void **state)
{
    (void)state;
    char note[512] = "";
    WrSessionOptions options = { .note = last_note, .note_ctx = note };
    WrSession *s = wr_session_new(&options);
    must_run(s, "replicate 1.5,2.5");
    assert_string_equal(note, ""); /* a plane is open */
    must_run(s, "surface torus");
    assert_non_null(strstr(note, "seam"));
    note[0] = '\0';
    must_run(s, "replicate -3,0");
    assert_string_equal(note, "");
    must_run(s, "replicate 0.5,1");
    assert_non_null(strstr(note, "seam"));
    wr_session_free(s);
}

static void expect_canonical(const char *line)
{
    WrCall *call;
    WrError err;
    WrText text = { 0 };
    if (!wr_call_parse(line, false, &call, &err)) fail_msg("%s: %s", line, err.text);
    wr_call_print(call, &text);
    assert_string_equal(wr_text_get(&text), line);
    wr_call_free(call);
    wr_text_fini(&text);
}

static void scene_text_restores_the_scene(void **state)
{
    (void)state;
    static const char *const scenes[][8] = {
        { NULL },
        { "surface sphere R=2", "rotate 10,-20.5,1e-3", "bump mode=invariant scheme=bspline-fit" },
        { "analytic fourier terms=3,-1,0.1,45,0;2,2,1e-20", "replicate 3,-0.1", "light clear" },
        { "analytic poly c=0,0,1;64,64,-2",
          "material model=ggx roughness=0.7 metalness=0.3 ior=1.7 tint=0.2",
          "material energy=published gate=off colour=0.1,0.2,0.30000000000000004" },
        { "light point at=1,2,3 strength=0.5", "light directional to=-1,-1,-1e-9 colour=0,0,1e6" },
        { "camera orthographic eye=1,2,3 target=4,5,6 size=0.125", "camera perspective fov=12.5",
          "dials aa=supersample samples=3 arithmetic=fast" },
        { "camera orthographic fit=on up=1,0,0", "surface bent c=0.1,0.2,0.3", "surface cube" },
        { "surface bezier", "rotate 0,0,0", "light directional to=1,0,0 index=1" },
    };
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        WrSession *a = session_of(scenes[i]), *b = wr_session_new(NULL);
        char *text = scene_text(a), *rest = text, *line;
        while ((line = strsep(&rest, "\n")) && *line) {
            must_run(b, line);
            expect_canonical(line);
        }
        char *again = scene_text(b), *first = scene_text(a);
        assert_string_equal(first, again);
        assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
        wr_free(text);
        wr_free(again);
        wr_free(first);
        wr_session_free(a);
        wr_session_free(b);
    }
}

static void different_scenes_have_different_hashes(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "fill 0.5",        "rotate 0,0,0",        "light clear",   "replicate 2,1",
        "bump height=0.2", "material gate=off",   "surface curl",  "analytic poly c=0,0,0",
        "dials samples=5", "camera orthographic", "table 512x511", "table 512x512 wrap=clamp"
    };
    WrHash seen[32];
    int count = 0;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrSession *s = session_of((const char *[]){ lines[i], NULL });
        seen[count++] = wr_session_hash(s);
        for (int k = 0; k + 1 < count; k++) assert_false(wr_hash_equal(seen[k], seen[count - 1]));
        wr_session_free(s);
    }
}

/* ---- failures ---- */

static void a_command_that_fails_changes_nothing(void **state)
{
    (void)state;
    static const char *const bad[] = {
        "fill",
        "nonsense",
        "image nosuchfile.png",
        "image /",
        "colour nosuchfile.png",
        ("colour off sha256="
         "0000000000000000000000000000000000000000000000000000000000000000"),
        "light directional to=0,0,0",
        "light point at=1,1,1 index=5",
        "camera perspective eye=1,1,1 target=1,1,1",
        "table 16385x1",
        "surface sphere R=0"
    };
    WrSession *s =
        session_of((const char *[]){ "table 96x80", "dab 0.5,0.5", "surface sphere", NULL });
    WrHash before = wr_session_hash(s);
    uint64_t key = wr_field_key(field_of(s));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        WrError err = { "" };
        if (wr_session_run(s, bad[i], &err)) fail_msg("accepted: %s", bad[i]);
        assert_true(err.text[0] != '\0');
        assert_true(wr_hash_equal(before, wr_session_hash(s)));
        assert_true(wr_field_key(field_of(s)) == key);
        assert_true(wr_session_revision(s) == 3);
        assert_string_equal(wr_session_last_command(s), "surface sphere");
    }
    wr_session_free(s);
}

static void history_keeps_the_canonical_lines_in_order(void **state)
{
    (void)state;
    WrSession *s =
        session_of((const char *[]){ " fill  0.50 # x", "# nothing", "", "bump height=1.0", NULL });
    assert_int_equal(wr_session_history_count(s), 2);
    assert_string_equal(wr_session_history_line(s, 0), "fill 0.5");
    assert_string_equal(wr_session_history_line(s, 1), "bump height=1");
    assert_string_equal(wr_session_history_line(s, 2), "");
    assert_string_equal(wr_session_history_line(s, -1), "");
    assert_string_equal(wr_session_last_command(s), "bump height=1");
    assert_true(wr_session_revision(s) == 2);
    wr_session_reset(s);
    assert_int_equal(wr_session_history_count(s), 0);
    assert_true(wr_session_revision(s) == wr_session_saved_revision(s));
    WrSession *empty = wr_session_new(NULL);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(empty)));
    wr_session_free(empty);
    wr_session_free(s);
}

/* ---- strokes in progress ---- */

#define SAMPLES 300

static WrSample sample_of(double u, double v, double pressure, double tilt_x, double tilt_y,
                          double seconds)
{
    return (WrSample){
        .u = u, .v = v, .pressure = pressure, .tilt_x = tilt_x, .tilt_y = tilt_y, .seconds = seconds
    };
}

static void random_samples(TestRandom *random, WrSample *samples, int count)
{
    double u = 0.5, v = 0.5;
    for (int i = 0; i < count; i++) {
        u += (test_random(random) - 0.5) * 0.1; /* sometimes leaves the table */
        v += (test_random(random) - 0.4) * 0.1;
        const double pressure = test_random(random) * 1.2;
        samples[i] = sample_of(u, v, pressure, test_random(random) - 0.5, 0, i / 97.0);
        if (i > count / 2) samples[i].turn_deg = 400 * test_random(random) - 200;
    }
}

static void an_open_stroke_equals_its_finished_line(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    WrSample samples[SAMPLES];
    WrError err;
    random_samples(&random, samples, SAMPLES);
    WrSession *a = wr_session_new(NULL), *b = wr_session_new(NULL), *c = wr_session_new(NULL);
    assert_true(wr_session_stroke_begin(a, "stroke radius=11.5 strength=0.25", &err));
    assert_true(wr_session_in_stroke(a));
    for (int i = 0; i < SAMPLES; i++) assert_true(wr_session_stroke_add(a, &samples[i], 1, &err));
    assert_true(wr_session_stroke_end(a, &err));
    assert_false(wr_session_in_stroke(a));
    must_run(b, wr_session_last_command(a));
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    assert_string_equal(wr_session_last_command(a), wr_session_last_command(b));
    /* In two parts, and from the numbers of the printed line: the same result. */
    assert_true(wr_session_stroke_begin(c, "stroke strength=0.25 radius=11.5", &err));
    assert_true(wr_session_stroke_add(c, samples, 123, &err));
    assert_true(wr_session_stroke_add(c, samples + 123, SAMPLES - 123, &err));
    assert_true(wr_session_stroke_end(c, &err));
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(c)));
    assert_string_equal(wr_session_last_command(a), wr_session_last_command(c));
    wr_session_free(a);
    wr_session_free(b);
    wr_session_free(c);
}

static void an_open_stroke_shows_at_once_and_keeps_others_out(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = session_of((const char *[]){ "table 64x64", NULL });
    WrSample sample = sample_of(0.5, 0.5, 1, 0, 0, 0);
    assert_true(wr_session_stroke_begin(s, "stroke radius=5 strength=2", &err));
    assert_true(wr_session_stroke_add(s, &sample, 1, &err));
    assert_true(wr_field_get(field_of(s), 32, 31) == 2);
    assert_false(wr_session_run(s, "fill 1", &err));
    assert_non_null(strstr(err.text, "stroke"));
    assert_false(wr_session_open(s, "/nosuchfile", &err));
    assert_non_null(strstr(err.text, "stroke"));
    assert_false(wr_session_stroke_begin(s, "stroke", &err));
    wr_session_stroke_cancel(s);
    assert_true(wr_field_get(field_of(s), 32, 31) == 0);
    assert_true(wr_session_revision(s) == 1);
    assert_false(wr_session_stroke_add(s, &sample, 1, &err));
    assert_false(wr_session_stroke_end(s, &err));
    wr_session_free(s);
}

static void a_stroke_without_samples_never_happened(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = wr_session_new(NULL);
    WrHash before = wr_session_hash(s);
    assert_true(wr_session_stroke_begin(s, "stroke", &err));
    assert_true(wr_session_stroke_end(s, &err));
    assert_int_equal(wr_session_history_count(s), 0);
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    assert_false(wr_session_stroke_begin(s, "dab 0,0", &err));
    assert_false(wr_session_stroke_begin(s, "stroke points=0,0", &err));
    assert_false(wr_session_stroke_begin(s, "stroke radius=-1", &err));
    assert_false(wr_session_stroke_begin(s, "", &err));
    assert_false(wr_session_in_stroke(s));
    wr_session_free(s);
}

static void hc74_a_wild_pen_is_clamped_or_refused(void **state)
{
    (void)state;
    WrError err;
    float low, high;
    WrSession *s = session_of((const char *[]){ "table 64x64", NULL });
    WrSample wild[] = { sample_of(0.1, 0.1, NAN, NAN, INFINITY, NAN),
                        sample_of(0.3, 0.1, -4, -INFINITY, 0, -1),
                        sample_of(0.5, 0.9, INFINITY, 2, 2, INFINITY) };
    WrSample lost = sample_of(NAN, 0.5, 1, 0, 0, 0), far = sample_of(0.5, 1e300, 1, 0, 0, 0);
    assert_true(wr_session_stroke_begin(s, "stroke radius=4 strength=1", &err));
    assert_true(wr_session_stroke_add(s, wild, 3, &err));
    assert_false(wr_session_stroke_add(s, &lost, 1, &err));
    assert_false(wr_session_stroke_add(s, &far, 1, &err));
    assert_true(wr_session_stroke_end(s, &err));
    wr_field_range(field_of(s), &low, &high);
    assert_true(low >= 0 && high <= 1 && high > 0.9);
    WrSession *again =
        session_of((const char *[]){ "table 64x64", wr_session_last_command(s), NULL });
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    wr_session_free(again);
    wr_session_free(s);
}

static void a_snapshot_of_an_open_stroke_stays_as_it_was(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = session_of((const char *[]){ "table 64x64", NULL });
    WrSample samples[] = { sample_of(0.25, 0.5, 1, 0, 0, 0), sample_of(0.75, 0.5, 1, 0, 0, 0) };
    assert_true(wr_session_stroke_begin(s, "stroke radius=5 strength=1", &err));
    assert_true(wr_session_stroke_add(s, samples, 1, &err));
    WrDocument *shot = wr_document_share(wr_session_document(s));
    WrHash before = wr_document_hash(shot, "");
    assert_true(wr_session_stroke_add(s, samples + 1, 1, &err));
    assert_true(wr_session_stroke_end(s, &err));
    assert_true(wr_hash_equal(before, wr_document_hash(shot, "")));
    assert_false(wr_hash_equal(before, wr_document_hash(wr_session_document(s), "")));
    wr_document_free(shot);
    wr_session_free(s);
}

/* As the window does after a dialog's preview: the result from a snapshot equals that of the line. */
static void a_line_whose_work_is_done_is_as_if_it_had_run(void **state)
{
    (void)state;
    static const char *const lines[] = { "adjust blur sigma=3", "adjust invert layers=all",
                                         "pattern dots", "noise perlin blend=max" };
    WrError err = { "" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        const char *const before[] = { "table 100x80",
                                       "grid cells=4x4",
                                       "layer add",
                                       "pattern bricks",
                                       "select ellipse centre=0.5,0.5 radii=0.3,0.3",
                                       NULL };
        WrSession *ran = session_of(before), *took = session_of(before);
        must_run(ran, lines[i]);
        assert_true(wr_session_takes_made(lines[i]));
        assert_true(wr_session_run_made(took, lines[i], doc(ran), &err));
        assert_true(wr_hash_equal(wr_session_hash(ran), wr_session_hash(took)));
        assert_string_equal(wr_session_last_command(ran), wr_session_last_command(took));
        must_run(took, "undo");
        must_run(ran, "undo");
        assert_true(wr_hash_equal(wr_session_hash(ran), wr_session_hash(took)));
        must_run(took, "layer set 2 lock=on");
        assert_false(wr_session_run_made(took, lines[i], doc(ran), &err) && i != 1);
        wr_session_free(ran);
        wr_session_free(took);
    }
    assert_false(wr_session_takes_made("table 3x3"));
    assert_false(wr_session_takes_made("text abc")); /* contains the name of a font file */
    assert_false(wr_session_takes_made("no such line"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_sets_size_and_wrap_and_starts_at_zero),
        cmocka_unit_test(grid_of_whole_cells_covers_the_texels_that_counting_gives),
        cmocka_unit_test(grid_is_half_open_at_a_line_of_odd_width),
        cmocka_unit_test(grid_whose_cells_do_not_divide_the_table_agrees_with_distances),
        cmocka_unit_test(dab_changes_its_centre_by_exactly_the_strength),
        cmocka_unit_test(a_stroke_of_one_point_is_a_dab),
        cmocka_unit_test(only_what_is_given_changes),
        cmocka_unit_test(surface_takes_defaults_for_what_is_left_out),
        cmocka_unit_test(bezier_points_come_u_index_fastest),
        cmocka_unit_test(the_first_light_takes_the_default_ones_place),
        cmocka_unit_test(the_camera_fits_until_an_eye_is_given),
        cmocka_unit_test(analytic_terms_arrive_with_their_phases),
        cmocka_unit_test(hc41_a_seam_on_a_closed_surface_is_noted),
        cmocka_unit_test(scene_text_restores_the_scene),
        cmocka_unit_test(different_scenes_have_different_hashes),
        cmocka_unit_test(a_command_that_fails_changes_nothing),
        cmocka_unit_test(history_keeps_the_canonical_lines_in_order),
        cmocka_unit_test(an_open_stroke_equals_its_finished_line),
        cmocka_unit_test(an_open_stroke_shows_at_once_and_keeps_others_out),
        cmocka_unit_test(a_stroke_without_samples_never_happened),
        cmocka_unit_test(hc74_a_wild_pen_is_clamped_or_refused),
        cmocka_unit_test(a_snapshot_of_an_open_stroke_stays_as_it_was),
        cmocka_unit_test(a_line_whose_work_is_done_is_as_if_it_had_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
