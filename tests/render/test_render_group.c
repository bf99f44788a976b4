/* Several objects: adaptive samples, and cached hits in a static view. */
#include "test.h"
#include "render_sets.h"

static Shot with_dials(const Set *set, WrAntialias aa, int k, double contrast)
{
    WrFrameRequest request = request_of(set);
    WrDials dials = set->together->dials;
    dials.aa = aa, dials.samples = k, dials.contrast = contrast;
    request.dials = &dials;
    return shoot_set(&request, 2, "auto");
}

/* Relief that pixels resolve. */
static void soften(Set *set)
{
    for (int i = 0; i < set->count; i++) {
        WrField *field = set->field[i];
        const int w = wr_field_width(field), h = wr_field_height(field);
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++)
                wr_field_set(
                    field, x, y,
                    (float)(0.3 * sin(2 * WR_PI * (x + 0.5) / w) * cos(2 * WR_PI * (y + 0.5) / h)));
    }
}

/* Narrow scratches, most of them between the first samples. */
static void scratch(Set *set)
{
    for (int n = 0; n < set->count; n++) {
        wr_field_free(set->field[n]);
        WrField *field = wr_field_new(301, 256, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        for (int j = 0; j < 256; j++)
            for (int i = 0; i < 301; i++)
                if ((i + j / 8) % 61 < 2) wr_field_set(field, i, j, 0.1f);
        set->fields[n] = set->field[n] = field;
    }
}

/* With a contrast of 0 no estimate suffices except under constant light. */
static void refined_pixels_have_the_bits_of_all_samples(void **state)
{
    (void)state;
    TestRandom random = { 613 };
    for (int k = 0; k < 10; k++) {
        Set set = some_set(&random, 2 + k % 4);
        const int samples = 2 + k % 4;
        if (k % 2) soften(&set);
        set.together->dials.spread = k % 3 ? WR_SPREAD_REGULAR : WR_SPREAD_JITTERED;
        Shot all = with_dials(&set, WR_AA_SUPERSAMPLE, samples, 0);
        Shot some = with_dials(&set, WR_AA_ADAPTIVE, samples, 0);
        assert_int_equal(all.frame.plan->sampling, WR_SAMPLING_ALL);
        if (!(worst_difference(&all, &some) <= 1e-6f))
            fail_msg("set %d: %g off", k, (double)worst_difference(&all, &some));
        put_away(&some);
        put_away(&all);
        put_set_away(&set);
    }
}

/* Number of pixels with a channel that differs by more than `within`. */
static int count_off(const Shot *all, const Shot *some, double than)
{
    int off = 0;
    for (int i = 0; i < W * H; i++) {
        float worst = 0;
        for (int c = 0; c < 4; c++)
            worst = fmaxf(worst, fabsf(all->frame.rgba[4 * i + c] - some->frame.rgba[4 * i + c]));
        off += (double)worst > than;
    }
    return off;
}

/* Sum of these numbers for separate pictures of each object. */
static int count_alone(const Set *set, int k, double within)
{
    int off = 0;
    for (int i = 0; i < set->count; i++) {
        WrScene *scene = set->alone[i];
        scene->dials.samples = k, scene->dials.contrast = within;
        scene->dials.aa = WR_AA_SUPERSAMPLE;
        Shot all = shoot(scene, set->field[i], W, H, 2, "auto", false);
        scene->dials.aa = WR_AA_ADAPTIVE;
        Shot some = shoot(scene, set->field[i], W, H, 2, "auto", false);
        off += count_off(&all, &some, within);
        put_away(&some);
        put_away(&all);
    }
    return off;
}

/* The guarantee for one object also holds for overlapping objects, and saves time. */
static void an_estimate_keeps_near_all_samples(void **state)
{
    (void)state;
    TestRandom random = { 88 };
    const double within = 1.0 / 512;
    int64_t taken = 0, most = 0;
    for (int k = 0; k < (getenv("WR_FULL") ? 60 : 12); k++) {
        Set set = some_set(&random, 2 + k % 3);
        if (k % 4 == 2) scratch(&set);
        else soften(&set);
        const int samples = k % 2 ? 8 : 4;
        Shot all = with_dials(&set, WR_AA_SUPERSAMPLE, samples, within);
        Shot some = with_dials(&set, WR_AA_ADAPTIVE, samples, within);
        assert_int_equal(some.frame.plan->sampling, WR_SAMPLING_ADAPTIVE);
        const int off = count_off(&all, &some, within);
        const int alone = count_alone(&set, samples, within);
        if (off >
            alone + W * H / 1000) /* slivers between the first samples, of one object in front of
                                     another */
            fail_msg("set %d, K = %d: %d pixels off, alone %d, %g at most", k, samples, off, alone,
                     (double)worst_difference(&all, &some));
        assert_in_range(llabs(all.frame.covered - some.frame.covered), 0, off);
        taken += some.frame.shaded, most += all.frame.shaded;
        put_away(&some);
        put_away(&all);
        put_set_away(&set);
    }
    assert_in_range(taken, 1, 3 * most / 4);
}

/* True if the pixel and its neighbours show several objects. */
static bool is_between(const Shot *point, int x, int y)
{
    int seen = 0, first = -1, object, face;
    double u, v;
    for (int k = 0; k < 9; k++) {
        if (!wr_renderer_pick_object(point->renderer, x + k % 3 - 0.5, y + k / 3 - 0.5, &object, &u,
                                     &v, &face))
            continue;
        if (first < 0) first = object;
        seen += object != first;
    }
    return seen > 0;
}

/* For any contrast: at borders between objects all samples are taken. */
static void all_samples_are_taken_between_objects(void **state)
{
    (void)state;
    TestRandom random = { 4 };
    int between = 0;
    for (int k = 0; k < 3; k++) {
        Set set = some_set(&random, 3);
        soften(&set);
        Shot point = with_dials(&set, WR_AA_POINT, 1, 1);
        Shot all = with_dials(&set, WR_AA_SUPERSAMPLE, 4, 1);
        Shot some = with_dials(&set, WR_AA_ADAPTIVE, 4, 1);
        for (int y = 1; y < H - 1; y++)
            for (int x = 1; x < W - 1; x++) {
                const size_t at = 4 * (size_t)(y * W + x);
                if (point.frame.rgba[at + 3] == 0 || !is_between(&point, x, y)) continue;
                assert_memory_equal(all.frame.rgba + at, some.frame.rgba + at, 4 * sizeof(float));
                between++;
            }
        put_away(&some);
        put_away(&all);
        put_away(&point);
        put_set_away(&set);
    }
    assert_in_range(between, 50, 10000);
}

/* ---- cached hits of a static view ---- */

/* A change that does not affect which object a sample shows. */
static void change_look(TestRandom *random, Set *set)
{
    const int own = (int)(set->count * test_random(random));
    WrField *next = wr_field_share(set->field[own]);
    wr_field_set(next, (int)(wr_field_width(next) * test_random(random)),
                 (int)(wr_field_height(next) * test_random(random)), (float)test_random(random));
    wr_field_free(set->field[own]);
    set->fields[own] = set->field[own] = next;
    if (test_random(random) < 0.5) return;
    WrScene *scene = wr_scene_clone(set->together);
    scene->lights[0].strength = between(random, 0.3, 1.2);
    scene->material.diffuse = between(random, 0.3, 1);
    wr_scene_free(set->together);
    set->together = scene;
}

static void change_view(TestRandom *random, Set *set)
{
    WrScene *scene = wr_scene_clone(set->together);
    if (test_random(random) < 0.5) scene->at.x += between(random, -0.5, 0.5);
    else if (test_random(random) < 0.5) scene->camera.fov_deg += 1, scene->camera.size *= 1.1;
    else scene->hidden = !scene->hidden;
    wr_scene_free(set->together);
    set->together = scene;
}

/* A frame of the renderer against a new renderer's. True if visibility was computed. */
static bool looks_anew(WrRenderer *renderer, const Set *set, int step)
{
    WrError err = { "" };
    WrFrame frame;
    WrFrameRequest request = request_of(set);
    request.keep = true;
    if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
    request.keep = false;
    Shot fresh = shoot_set(&request, 1, "auto");
    if (memcmp(frame.rgba, fresh.frame.rgba, frame_bytes(&frame)) != 0)
        fail_msg("step %d: another picture", step);
    put_away(&fresh);
    assert_int_equal(wr_plan_runs(frame.plan, WR_EFFECT_DEPTH),
                     wr_plan_runs(frame.plan, WR_EFFECT_NEWTON));
    assert_true(!frame.plan->rows[WR_EFFECT_DEPTH].ran ||
                wr_plan_runs(frame.plan, WR_EFFECT_DEPTH));
    return wr_plan_runs(frame.plan, WR_EFFECT_DEPTH);
}

static void hits_are_found_once_while_objects_rest(void **state)
{
    (void)state;
    TestRandom random = { 12 };
    int anew = 0;
    for (int k = 0; k < (getenv("WR_FULL") ? 60 : 10); k++) {
        Set set = some_set(&random, 2 + k % 4);
        WrPool *pool = wr_pool_new(1 + k % 3);
        WrRenderer *renderer = wr_renderer_new(pool, NULL, NULL);
        bool rests = false;
        for (int step = 0; step < 14; step++) {
            const bool looked = looks_anew(renderer, &set, step);
            if (rests && looked) fail_msg("set %d, step %d: hits were found anew", k, step);
            anew += looked;
            rests = test_random(&random) < 0.7;
            change_look(&random, &set);
            if (!rests) change_view(&random, &set);
        }
        wr_renderer_free(renderer);
        wr_pool_free(pool);
        put_set_away(&set);
    }
    assert_in_range(anew, 10, 1000);
}

/* An object that filled the picture moves aside: the objects behind it had no cached visibility. */
static void what_was_hidden_is_looked_at_when_it_is_seen(void **state)
{
    (void)state;
    TestRandom random = { 3 };
    WrScene *front = scene_of("plane"), *back = scene_of("torus");
    Set set = { .count = 2, .together = front };
    front->size = 9;
    front->camera = (WrCamera){
        .orthographic = true, .eye = { 0, 0, 9 }, .up = { 0, 1, 0 }, .fov_deg = 30, .size = 2.5
    };
    back->at = (WrVec3){ 0, 0, -3 };
    front->others = wr_alloc(1, sizeof *front->others);
    front->others[front->other_count++] = back;
    for (int i = 0; i < 2; i++) set.fields[i] = set.field[i] = random_field(64, 48, 3);
    WrPool *pool = wr_pool_new(2);
    WrRenderer *renderer = wr_renderer_new(pool, NULL, NULL);
    looks_anew(renderer, &set, 0);
    for (int step = 1; step < 4; step++) {
        WrScene *moved = wr_scene_clone(set.together);
        moved->at.x += 1.7;
        wr_scene_free(set.together);
        set.together = moved;
        assert_true(looks_anew(renderer, &set, step));
        change_look(&random, &set);
        assert_false(looks_anew(renderer, &set, step));
    }
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    wr_scene_free(set.together);
    for (int i = 0; i < 2; i++) wr_field_free(set.field[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refined_pixels_have_the_bits_of_all_samples),
        cmocka_unit_test(all_samples_are_taken_between_objects),
        cmocka_unit_test(hits_are_found_once_while_objects_rest),
        cmocka_unit_test(what_was_hidden_is_looked_at_when_it_is_seen),
        cmocka_unit_test(an_estimate_keeps_near_all_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
