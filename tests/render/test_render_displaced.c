/* Displaced surfaces: silhouettes against closed forms, skipped displacement, endless cases. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"
#include "mesh_grids.h"

#include "render/frame/frame_internal.h"
#include "render/kernels/kern.h"
#include "render/plan/plan.h"
#include "scene/objects.h"

static WrScene *displaced_of(const char *surface, double height)
{
    WrScene *scene = scene_of(surface);
    scene->displaced = true;
    scene->height = height;
    return scene;
}

/* ---- closed forms ---- */

/* The sphere of radius R + c, seen from d, has a silhouette of radius f (R + c) / sqrt(d^2 - (R + c)^2). */
static void a_raised_ball_is_a_larger_ball(void **state)
{
    (void)state;
    static const double way[][3] = { { 0.83, 0.137, 4.1 }, { 1.21, -0.31, 5.3 } };
    for (int k = 0; k < 2; k++) {
        WrScene *scene = displaced_of("sphere", 0.73);
        WrField *field = level_field(37, 22, way[k][1] / 0.73);
        scene->shape.value[0] = way[k][0];
        look_from(scene, 0, 0, way[k][2]);
        Shot shot = shoot(scene, field, 301, 301, 2, "auto", false);
        assert_true(wr_plan_runs(shot.frame.plan, WR_EFFECT_DISPLACED));
        const double want = seen_radius(scene, 301, way[k][0] + way[k][1], way[k][2]);
        assert_near(sqrt((double)shot.frame.covered / WR_PI), want, 0.5);
        put_away(&shot);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* A plane at distance d that faces the eye and is raised by c grows by d / (d - c), which bump mapping does not
   show. */
static void a_raised_plane_comes_nearer(void **state)
{
    (void)state;
    const double c = 0.4173, d = 2.9;
    WrField *field = level_field(37, 22, c);
    double side[2];
    for (int k = 0; k < 2; k++) {
        WrScene *scene = displaced_of("plane", 1);
        scene->displaced = k == 1;
        scene->still = true;
        look_from(scene, 0, 0, d);
        Shot shot = shoot(scene, field, 301, 301, 1, "auto", false);
        side[k] = sqrt((double)shot.frame.covered);
        put_away(&shot);
        wr_scene_free(scene);
    }
    const double f = 150.5 / tan(35 * WR_PI / 360);
    assert_near(side[0], f / d, 1);
    assert_near(side[1], f / (d - c), 1);
    wr_field_free(field);
}

/* ---- endless cases (HC125) ---- */

static void no_heights_make_nonsense(void **state)
{
    (void)state;
    static const double height[] = { -1, 1e6 };
    for (int k = 0; k < 2; k++) {
        WrField *field = k == 0 ? level_field(37, 22, 1) : random_field(31, 17, 5);
        WrScene *scene = displaced_of("sphere", height[k]), *base = scene_of("sphere");
        wr_scene_hold_camera(scene, base, 40.0 / 33); /* from inside, not from afar */
        Shot shot = shoot(scene, field, 40, 33, 2, "auto", false);
        for (int i = 0; i < 40 * 33 * 4; i++) assert_true(isfinite(shot.frame.rgba[i]));
        const char *why = shot.frame.plan->rows[WR_EFFECT_DISPLACED].reason;
        assert_int_equal(strstr(why, "as many as there may be") != NULL, k == 1);
        put_away(&shot);
        wr_scene_free(scene);
        wr_scene_free(base);
        wr_field_free(field);
    }
}

/* ---- skipped displacement (E50) ---- */

/* Below half a pixel: bit-identical to bump mapping. */
static void what_nobody_sees_is_bump(void **state)
{
    (void)state;
    WrField *field = random_field(64, 64, 9);
    WrScene *flat = scene_of("sphere"), *raised = displaced_of("sphere", 0.001);
    flat->height = 0.001;
    Shot a = shoot(flat, field, 150, 150, 1, "auto", false);
    Shot b = shoot(raised, field, 150, 150, 1, "auto", false);
    assert_false(wr_plan_runs(b.frame.plan, WR_EFFECT_DISPLACED));
    assert_true(same_picture(&a, &b));
    put_away(&a);
    put_away(&b);
    wr_scene_free(flat);
    wr_scene_free(raised);
    wr_field_free(field);
}

static void the_bits_are_the_same(void **state)
{
    (void)state;
    static const char *const isas[] = { "v1", "v3", "v4" };
    static const char *const kinds[] = { "torus", "cube", "cone" };
    WrField *field = random_field(33, 20, 8);
    for (int i = 0; i < 3; i++) {
        WrScene *scene = displaced_of(kinds[i], 0.07);
        scene->scheme = i == 0 ? WR_SCHEME_BSPLINE : WR_SCHEME_CENTRAL;
        if (i == 1) scene->dials.aa = WR_AA_SUPERSAMPLE, scene->dials.samples = 2;
        Shot first = shoot(scene, field, 111, 90, 1, "ref", false);
        assert_true(wr_plan_runs(first.frame.plan, WR_EFFECT_DISPLACED));
        for (int k = 0; k < 3; k++) {
            if (!wr_kernels_get(isas[k], false, NULL)) continue;
            Shot other = shoot(scene, field, 111, 90, 2, isas[k], k == 1);
            if (!same_picture(&first, &other)) fail_msg("%s, %s", kinds[i], isas[k]);
            put_away(&other);
        }
        put_away(&first);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* ---- kept facets ---- */

/* A sphere, a torus, a cube, and a mesh of a sphere. */
static WrScene *kept_scene(int which)
{
    static const char *const kinds[] = { "sphere", "torus", "cube", "sphere" };
    WrScene *scene = displaced_of(kinds[which], 0.11);
    scene->scheme = which == 1 ? WR_SCHEME_BSPLINE_FIT : WR_SCHEME_CENTRAL;
    if (which == 3) wr_scene_set_triangles(scene, mesh_grid(on_sphere, 24, 17, true), "m.ply", "");
    return scene;
}

static void render_turned(Shot *shot, const WrScene *scene, const WrField *field, double turn_deg,
                          bool moving)
{
    WrError err = { "" };
    const WrFrameRequest request = { .field = field,
                                     .scene = scene,
                                     .width = 133,
                                     .height = 118,
                                     .turn_deg = turn_deg,
                                     .moving = moving };
    if (!wr_renderer_frame(shot->renderer, &request, &shot->frame, &err)) fail_msg("%s", err.text);
}

/* Compares with the picture of a new renderer. */
static void expect_fresh(const Shot *kept, const WrScene *scene, const WrField *field,
                         double turn_deg, bool moving, int which)
{
    Shot fresh = { .pool = wr_pool_new(2) };
    fresh.renderer = wr_renderer_new(fresh.pool, "auto", NULL);
    render_turned(&fresh, scene, field, turn_deg, moving);
    if (!same_picture(kept, &fresh)) fail_msg("scene %d, turn %g", which, turn_deg);
    put_away(&fresh);
}

static void kept_facets_make_the_same_picture(void **state)
{
    (void)state;
    for (int which = 0; which < 4; which += test_amount(1, 3)) {
        WrField *field = random_field(45, 32, 5);
        WrScene *scene = kept_scene(which);
        Shot kept = shoot(scene, field, 133, 118, 2, "auto", false);
        const WrDice *dice = &kept.renderer->dice;
        assert_true(wr_plan_runs(kept.frame.plan, WR_EFFECT_DISPLACED));
        render_turned(&kept, scene, field, 20, true);
        const WrTriangles *few = dice->triangles;
        const int64_t covered = kept.frame.covered;
        render_turned(&kept, scene, field, 71, true);
        assert_ptr_equal(dice->triangles, few); /* turning makes no new ones */
        expect_fresh(&kept, scene, field, 71, true, which);
        render_turned(&kept, scene, field, 71, false);
        expect_fresh(&kept, scene, field, 71, false, which);
        const WrTriangles *fine = dice->triangles;
        assert_ptr_not_equal(fine, few);
        assert_true(fine->triangle_count != few->triangle_count);
        render_turned(&kept, scene, field, 20, false);
        assert_ptr_not_equal(dice->triangles, fine); /* they belong to one view */
        /* outlines are within two dials of the surface, a pixel: the perimeter of a disc of that area */
        assert_near((double)kept.frame.covered, (double)covered, 2 * sqrt(WR_PI * (double)covered));

        fine = dice->triangles;
        WrScene *other = wr_scene_clone(scene);
        other->material.diffuse *= 0.5;
        render_turned(&kept, other, field, 20, false);
        assert_ptr_equal(dice->triangles, fine); /* material leaves them */
        expect_fresh(&kept, other, field, 20, false, which);
        WrScene *higher = wr_scene_clone(other);
        higher->height *= 1.25;
        render_turned(&kept, higher, field, 20, true);
        expect_fresh(&kept, higher, field, 20, true, which);
        wr_field_set(field, 22, 15, 2.5f);
        render_turned(&kept, higher, field, 20, true);
        expect_fresh(&kept, higher, field, 20, true, which);
        if (which == 3) { /* the same file with a mask */
            WrProjection masked = higher->projection;
            masked.facing = WR_FACING_Z;
            assert_true(wr_surfaces[higher->shape.kind]->held);
            assert_true(wr_scene_project(higher, &masked, NULL));
            render_turned(&kept, higher, field, 20, true);
            expect_fresh(&kept, higher, field, 20, true, which);
        }
        put_away(&kept);
        wr_scene_free(higher);
        wr_scene_free(other);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* Noise of 512 x 512 texels needs more facets than there may be: the limit is used, instead of an error so large that
   the relief is lost. */
static void a_rough_moving_mesh_has_as_many_facets_as_there_may_be(void **state)
{
    (void)state;
    WrField *field = random_field(128, 128, 7);
    WrScene *scene = displaced_of("sphere", 0.3);
    wr_scene_set_triangles(scene, mesh_grid(on_plane, 1, 1, true), "m.ply", "");
    scene->replicate_u = scene->replicate_v = 4;
    Shot shot = { .pool = wr_pool_new(2) };
    shot.renderer = wr_renderer_new(shot.pool, "auto", NULL);
    render_turned(&shot, scene, field, 20, true);
    const int facets = shot.renderer->dice.triangles->triangle_count;
    assert_true(facets > WR_DICE_MOVING_MAX && facets < WR_DICE_MOVING_MAX + 1000);
    put_away(&shot);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_raised_ball_is_a_larger_ball),
        cmocka_unit_test(a_raised_plane_comes_nearer),
        cmocka_unit_test(no_heights_make_nonsense),
        cmocka_unit_test(what_nobody_sees_is_bump),
        cmocka_unit_test(the_bits_are_the_same),
        cmocka_unit_test(kept_facets_make_the_same_picture),
        cmocka_unit_test(a_rough_moving_mesh_has_as_many_facets_as_there_may_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
