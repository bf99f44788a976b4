/* test_effect_heatmap.c - the effect map of a picture matches the effects that ran: compared with the counts of the plan's rows
   and with pictures known pixel by pixel. */
#include "test.h"
#include "render_scenes.h"

#include "image/image.h"

#define SIDE 160
#define PIXELS (SIDE * SIDE)

static const char *const surfaces[] = { "sphere", "torus", "plane", "cube", "cone" };
#define SURFACES ((int)(sizeof surfaces / sizeof *surfaces))

typedef struct Mapped {
    Shot shot;
    uint8_t map[PIXELS];
} Mapped;

static void draw(Mapped *mapped, const WrScene *scene, const WrField *field, bool keep, bool noted)
{
    WrFrameRequest request = { .field = field,
                               .scene = scene,
                               .width = SIDE,
                               .height = SIDE,
                               .keep = keep,
                               .map = noted ? mapped->map : NULL };
    memset(mapped->map, 0, sizeof mapped->map);
    assert_true(wr_renderer_frame(mapped->shot.renderer, &request, &mapped->shot.frame, NULL));
}

static Mapped *start(int threads)
{
    Mapped *mapped = calloc(1, sizeof *mapped);
    mapped->shot.pool = wr_pool_new(threads);
    mapped->shot.renderer = wr_renderer_new(mapped->shot.pool, "auto", NULL);
    return mapped;
}

static void stop(Mapped *mapped)
{
    put_away(&mapped->shot);
    free(mapped);
}

static int64_t count_of(const Mapped *mapped, int bit)
{
    int64_t count = 0;
    for (int i = 0; i < PIXELS; i++) count += (mapped->map[i] & bit) != 0;
    return count;
}

static const float *pixel(const Mapped *mapped, int i)
{
    return mapped->shot.frame.rgba + 4 * (size_t)i;
}

static bool same_pixel(const Mapped *a, const Mapped *b, int i)
{
    return memcmp(pixel(a, i), pixel(b, i), 4 * sizeof(float)) == 0;
}

/* Slopes on a few tiles only. */
static WrField *mostly_level(void)
{
    WrField *field = wr_field_new(512, 512, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 200; j < 220; j++)
        for (int i = 100; i < 120; i++) wr_field_set(field, i, j, (float)(i * j % 7) / 7);
    return field;
}

/* Black and white, texel by texel. */
static WrImage *checker(int width, int height)
{
    WrImage *image = wr_image_new(width, height, 1, NULL);
    for (int i = 0; i < width * height; i++) image->data[i] = (float)((i % width + i / width) & 1);
    return image;
}

/* With one sample per pixel the rows' counts equal the map's, also where the picture is empty. */
static void check_counts(WrScene *scene, const WrField *field)
{
    Mapped *one = start(1), *four = start(4), *plain = start(2);
    draw(one, scene, field, false, true);
    draw(four, scene, field, false, true);
    draw(plain, scene, field, false, false);
    const WrPlan *plan = one->shot.frame.plan;
    assert_memory_equal(one->map, four->map, PIXELS);
    for (int i = 0; i < PIXELS; i++) {
        assert_true(same_pixel(one, plain, i));
        assert_int_equal((one->map[i] & WR_MAP_COVERED) != 0, pixel(one, i)[3] > 0);
        assert_true(one->map[i] & WR_MAP_RENDERED);
        assert_true(one->map[i] < WR_MAP_SAMPLES);
    }
    if (wr_plan_runs(plan, WR_EFFECT_BUMP))
        assert_int_equal(count_of(one, WR_MAP_LOOKED), plan->rows[WR_EFFECT_BUMP].pixels);
    else assert_int_equal(count_of(one, WR_MAP_LOOKED), 0);
    if (wr_plan_runs(plan, WR_EFFECT_FILTER))
        assert_int_equal(count_of(one, WR_MAP_WIDE), plan->rows[WR_EFFECT_FILTER].pixels);
    else if (wr_plan_runs(plan, WR_EFFECT_TINT))
        assert_int_equal(count_of(one, WR_MAP_WIDE), plan->rows[WR_EFFECT_TINT].pixels);
    else assert_int_equal(count_of(one, WR_MAP_WIDE), 0);
    stop(one);
    stop(four);
    stop(plain);
}

static void one_sample_is_counted_as_the_rows_count(void **state)
{
    static const WrAntialias aas[] = { WR_AA_POINT, WR_AA_FILTER, WR_AA_MOMENTS };
    WrField *fields[] = { bumpy_field(64, 64), mostly_level() };
    (void)state;
    for (int k = 0; k < SURFACES * 3 * 2; k++) {
        WrScene *scene = scene_of(surfaces[k % SURFACES]);
        scene->replicate_u = scene->replicate_v = k % 2 + 1;
        scene->dials.aa = aas[k / SURFACES % 3];
        scene->dials.shading = k % 7 == 0 ? WR_SHADING_DOUBLE : scene->dials.shading;
        scene->bump = k % 11 == 0 ? WR_BUMP_NONE : WR_BUMP_BLINN;
        if (k % 3 == 0 || k % 11 == 0) scene->colour = checker(64 + k, 33);
        check_counts(scene, fields[k / SURFACES / 3]);
        wr_scene_free(scene);
    }
    wr_field_free(fields[0]);
    wr_field_free(fields[1]);
}

/* Pixels marked with one sample equal the one-sample picture, adjusted by their neighbours but not across a
   silhouette; pixels marked K x K equal the K x K picture. */
static void samples_are_those_that_were_taken(void **state)
{
    WrField *field = bumpy_field(64, 64);
    int refined = 0;
    (void)state;
    for (int k = 0; k < SURFACES; k++) {
        WrScene *scene = scene_of(surfaces[k]);
        Mapped *adaptive = start(3), *one = start(1), *all = start(1);
        scene->dials.samples = 4;
        scene->dials.aa = WR_AA_POINT;
        draw(one, scene, field, false, true);
        scene->dials.aa = WR_AA_SUPERSAMPLE;
        draw(all, scene, field, false, true);
        scene->dials.aa = WR_AA_ADAPTIVE;
        draw(adaptive, scene, field, false, true);
        /* A mesh is finer with more samples, and Newton's method starts elsewhere: the last bits differ. */
        const bool closed = !wr_plan_runs(all->shot.frame.plan, WR_EFFECT_DEPTH);
        int64_t of[4] = { 0 };
        for (int i = 0; i < PIXELS; i++) {
            const int level = adaptive->map[i] / WR_MAP_SAMPLES;
            assert_in_range(level, 0, 2);
            of[level]++;
            const float *a = pixel(adaptive, i), *b = pixel(one, i);
            for (int c = 0; c < 4 && level == 0 && closed; c++)
                assert_true(fabsf(a[c] - b[c]) <= (c < 3 ? 0.02f : 0));
            if (level == 2) assert_true(same_pixel(adaptive, all, i));
            if (pixel(adaptive, i)[3] > 0) assert_true(adaptive->map[i] & WR_MAP_COVERED);
            assert_int_equal(all->map[i] / WR_MAP_SAMPLES, 2);
            assert_int_equal((all->map[i] & WR_MAP_COVERED) != 0, pixel(all, i)[3] > 0);
        }
        const bool lively = adaptive->shot.frame.plan->sampling == WR_SAMPLING_ALL;
        assert_true((of[0] > 0 || lively) && of[2] > 0);
        refined += !lively;
        stop(adaptive);
        stop(one);
        stop(all);
        wr_scene_free(scene);
    }
    assert_true(refined > 2);
    wr_field_free(field);
}

/* A static view: the map marks the parts rendered again after an edit. */
static void tiles_rendered_again_are_told(void **state)
{
    WrField *field = bumpy_field(64, 64);
    WrScene *scene = scene_of("plane");
    Mapped *mapped = start(2), *before = start(2);
    (void)state;
    scene->replicate_u = scene->replicate_v = 1;
    draw(mapped, scene, field, true, true);
    draw(before, scene, field, true, true);
    assert_int_equal(count_of(mapped, WR_MAP_RENDERED), PIXELS);
    wr_field_set(field, 20, 30, 3);
    draw(mapped, scene, field, true, true);
    const int64_t again = count_of(mapped, WR_MAP_RENDERED);
    assert_true(again > 0 && again < PIXELS);
    for (int i = 0; i < PIXELS; i++)
        if (!same_pixel(mapped, before, i)) assert_true(mapped->map[i] & WR_MAP_RENDERED);
    stop(mapped);
    stop(before);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* A static view without a map is rendered completely for one. */
static void a_map_of_a_resting_view_is_whole(void **state)
{
    WrField *field = bumpy_field(64, 64);
    WrScene *scene = scene_of("sphere");
    Mapped *mapped = start(2);
    (void)state;
    draw(mapped, scene, field, true, false);
    draw(mapped, scene, field, true, true);
    assert_int_equal(count_of(mapped, WR_MAP_RENDERED), PIXELS);
    draw(mapped, scene, field, true, true);
    assert_int_equal(count_of(mapped, WR_MAP_RENDERED), 0);
    stop(mapped);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* Skipped work on the dark side: counted as in the rows, and distinguished from light without bump. */
static void the_dark_side_is_told(void **state)
{
    WrField *field = mostly_level();
    WrScene *scene = scene_of("sphere");
    Mapped *mapped = start(3);
    (void)state;
    scene->lights[0].where = (WrVec3){ 0.2, 1, -0.5 };
    draw(mapped, scene, field, false, true);
    const WrPlanRow *rows = mapped->shot.frame.plan->rows;
    assert_int_equal(count_of(mapped, WR_MAP_LIT), rows[WR_EFFECT_DIFFUSE].pixels);
    assert_in_range(rows[WR_EFFECT_DIFFUSE].pixels, 1, mapped->shot.frame.shaded - 1);
    for (int i = 0; i < PIXELS; i++)
        if (mapped->map[i] & WR_MAP_LOOKED) assert_true(mapped->map[i] & WR_MAP_LIT);
    stop(mapped);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_sample_is_counted_as_the_rows_count),
        cmocka_unit_test(samples_are_those_that_were_taken),
        cmocka_unit_test(tiles_rendered_again_are_told),
        cmocka_unit_test(a_map_of_a_resting_view_is_whole),
        cmocka_unit_test(the_dark_side_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
