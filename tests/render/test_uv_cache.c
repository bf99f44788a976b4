/* uv cache of a static view: after any change of light, material, table, bump or scheme the picture is bit-identical
   to a new renderer's, without depth buffer and Newton's method; a change of view, size or shape, or of other inputs
   of (u,v), clears the cache (S29). */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

static double one_of(TestRandom *random, const double *values, int count)
{
    return values[(int)(count * test_random(random))];
}

static WrScene *curved_scene(TestRandom *random)
{
    static const char *const surfaces[] = { "torus", "bezier", "ribbon", "bent", "curl" };
    WrScene *scene = scene_of(surfaces[(int)(5 * test_random(random))]);
    scene->camera.orthographic = test_random(random) < 0.4;
    scene->camera.size = 1.3 + test_random(random);
    scene->dials.arithmetic = test_random(random) < 0.5 ? WR_ARITHMETIC_FAST : WR_ARITHMETIC_EXACT;
    return scene;
}

/* A change without effect on (u,v). */
static void change_look(TestRandom *random, WrScene *scene, WrField **field)
{
    WrField *next = wr_field_share(*field);
    scene->material.diffuse = 0.2 + test_random(random);
    scene->material.specular = test_random(random) < 0.3 ? 0 : test_random(random);
    scene->material.shininess = 1 + 60 * test_random(random);
    scene->height = test_random(random) < 0.2 ? 0 : 0.1 * test_random(random);
    scene->scheme = (WrScheme)(WR_SCHEME_COUNT * test_random(random));
    scene->bump = test_random(random) < 0.7 ? WR_BUMP_BLINN : WR_BUMP_INVARIANT;
    wr_field_set(next, (int)(wr_field_width(next) * test_random(random)),
                 (int)(wr_field_height(next) * test_random(random)), (float)test_random(random));
    wr_field_free(*field);
    *field = next;
}

/* A change with effect on (u,v). */
static void change_view(TestRandom *random, WrScene *scene, double *turn)
{
    static const double turns[] = { 3.3, -40, 77.7 };
    switch ((int)(5 * test_random(random))) {
    case 0: *turn += one_of(random, turns, 3); break;
    case 1: scene->shape.value[0] += 0.013; break;
    case 2: scene->camera.orthographic = !scene->camera.orthographic; break;
    case 3: scene->dials.mesh = scene->dials.mesh == 0 ? 1 : 0; break;
    default: scene->dials.newton = scene->dials.newton < 0 ? 2 : -1; break;
    }
}

static bool looks(const WrFrame *frame)
{
    return wr_plan_runs(frame->plan, WR_EFFECT_DEPTH);
}

static void a_resting_view_shows_what_a_new_one_shows(void **state)
{
    (void)state;
    TestRandom random = { 77 };
    WrError err = { "" };
    int spared = 0, anew = 0;
    for (int k = 0; k < (getenv("WR_FULL") ? 200 : 16); k++) {
        WrField *field = random_field(31 + k, 47, (uint64_t)k);
        WrScene *scene = curved_scene(&random);
        WrPool *pool = wr_pool_new(1 + k % 3 * 3);
        WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
        const int w = 90 + (int)(300 * test_random(&random)), h = 61 + k;
        double turn = 15;
        bool same = false;
        for (int step = 0; step < 12; step++) {
            WrFrame frame, fresh;
            WrScene *shown = wr_scene_clone(scene);
            const WrFrameRequest request = { .field = field,
                                             .scene = shown,
                                             .width = w,
                                             .height = h,
                                             .turn_deg = turn,
                                             .keep = true };
            if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
            WrPool *other = wr_pool_new(2);
            WrRenderer *clean = wr_renderer_new(other, NULL, &err);
            WrFrameRequest once = request;
            once.keep = false;
            assert_true(wr_renderer_frame(clean, &once, &fresh, &err));
            if (memcmp(frame.rgba, fresh.rgba, frame_bytes(&frame)) != 0)
                fail_msg("scene %d, step %d: another picture", k, step);
            assert_int_equal(frame.covered, fresh.covered);
            if (looks(&frame) == same)
                fail_msg("scene %d, step %d: depth and Newton ran: %d", k, step, same);
            assert_true(looks(&fresh));
            double at[2][2];
            int face;
            const bool hit = wr_renderer_pick(clean, w / 2.0, h / 2.0, &at[0][0], &at[0][1], &face);
            assert_int_equal(
                wr_renderer_pick(renderer, w / 2.0, h / 2.0, &at[1][0], &at[1][1], &face), hit);
            if (hit) assert_true(at[0][0] == at[1][0] && at[0][1] == at[1][1]);
            spared += same;
            anew += !same;
            wr_renderer_free(clean);
            wr_pool_free(other);
            wr_scene_free(shown);
            same = test_random(&random) < 0.7;
            change_look(&random, scene, &field);
            if (!same) change_view(&random, scene, &turn);
        }
        wr_renderer_free(renderer);
        wr_pool_free(pool);
        wr_scene_free(scene);
        wr_field_free(field);
    }
    assert_in_range(spared, 40, 100000);
    assert_in_range(anew, 20, 100000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_resting_view_shows_what_a_new_one_shows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
