/* Painting on the patch: from a pixel to (u,v) and back. */
#include "test.h"

#include "base/error.h"
#include "base/pool.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/triangles.h"
#include "base/vec.h"

#include "ui/patch/preview/patch_pick.h"

#include <math.h>
#include <stdlib.h>

#define W 320
#define H 260
#define TURN 37.0

static double random01(void)
{
    static uint32_t state = 7;
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / 16777216.0;
}

static WrScene *scene_of(WrSurfaceKind kind, bool orthographic)
{
    WrScene *scene = wr_scene_new();
    scene->shape.kind = kind;
    wr_shape_default(kind, &scene->shape);
    scene->camera.orthographic = orthographic;
    return scene;
}

static WrVec3 point_of(const WrScene *scene, int face, double u, double v)
{
    WrSurfacePoint s;
    wr_surface_at(&scene->shape, face, u, v, &s);
    return s.p;
}

static WrPatchPick *pick_of(const WrScene *scene)
{
    WrError err = { "" };
    WrPatchPick *pick = wr_patch_pick_new(scene, TURN, W, H, &err);
    if (!pick) fail_msg("%s", err.text);
    return pick;
}

/* Cosine between the normal and the direction to the eye. */
static double facing(const WrScene *scene, int face, double u, double v)
{
    WrPlacement at;
    WrSurfacePoint s;
    WrError err;
    assert_true(wr_scene_place(scene, TURN, (double)W / H, &at, &err));
    wr_surface_at(&scene->shape, face, u, v, &s);
    const double *r = at.rotation;
    WrVec3 p = v3_sub(s.p, at.centre), n = s.n_unit;
    WrVec3 world = { r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
                     r[6] * p.x + r[7] * p.y + r[8] * p.z };
    WrVec3 across = { r[0] * n.x + r[1] * n.y + r[2] * n.z, r[3] * n.x + r[4] * n.y + r[5] * n.z,
                      r[6] * n.x + r[7] * n.y + r[8] * n.z };
    WrVec3 eye =
        at.orthographic ? v3_neg(at.forward) : v3_unit(v3_sub(at.eye, world), (WrVec3){ 0, 0, 1 });
    return fabs(v3_dot(eye, across));
}

/* Visible points of each surface are found again from their pixel. Compared in space: at a pole every u is the same
 * point. */
static void check_round_trip(WrSurfaceKind kind, bool orthographic, bool cells)
{
    WrScene *scene = scene_of(kind, orthographic);
    if (cells) scene->shape.value[wr_surface_param_offset(kind, "faces")] = 6;
    WrPatchPick *pick = pick_of(scene);
    double radius = wr_shape_radius(&scene->shape);
    int seen = 0, lost = 0;
    for (int i = 0; i < 600; i++) {
        int face = (int)(random01() * wr_surfaces[kind]->faces);
        const WrSurfaceCell c = wr_surface_cell(&scene->shape, face);
        double u = c.u0 + (c.u1 - c.u0) * random01(), v = c.v0 + (c.v1 - c.v0) * random01();
        WrPatchSpot there, back;
        bool hidden;
        if (!wr_patch_pick_project(pick, face, u, v, &there, &hidden) || hidden) continue;
        if (facing(scene, face, u, v) < 0.15) continue; /* a silhouette passes through that pixel */
        seen++;
        if (!wr_patch_pick_at(pick, there.x, there.y, &back)) {
            lost++;
            continue;
        }
        assert_near(back.x, there.x, 1e-4);
        assert_near(back.y, there.y, 1e-4);
        double off =
            v3_len(v3_sub(point_of(scene, face, u, v), point_of(scene, back.face, back.u, back.v)));
        /* or another layer, nearer by less than the tolerance for hidden points */
        double nearer = there.depth - back.depth;
        if (off > 1e-5 * radius && (nearer > 0.02 * radius || nearer < -1e-5 * radius)) lost++;
    }
    assert_true(seen > 100);
    /* where a nearer layer ends within a fraction of a pixel */
    if (lost * 50 > seen) fail_msg("%s: %d of %d lost", wr_surfaces[kind]->name, lost, seen);
    wr_patch_pick_free(pick);
    wr_scene_free(scene);
}

static void what_is_seen_is_found_under_its_pixel_on_every_surface(void **state)
{
    (void)state;
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++)
        for (int o = 0; o < 2; o++) check_round_trip((WrSurfaceKind)kind, o, false);
    check_round_trip(WR_SURFACE_cube, false, true);
}

static void it_finds_what_the_renderer_shows_there(void **state)
{
    (void)state;
    WrError err = { "" };
    WrField *field = wr_field_new(16, 16, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, &err);
    WrPool *pool = wr_pool_new(2);
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrScene *scene = scene_of((WrSurfaceKind)kind, false);
        WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = W, .height = H, .turn_deg = TURN
        };
        WrFrame frame;
        assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
        WrPatchPick *pick = pick_of(scene);
        double radius = wr_shape_radius(&scene->shape);
        int hits = 0, differ = 0;
        for (int k = 0; k < W * H; k += 7) {
            double x = k % W + 0.5, y = k / W + 0.5, u, v;
            int face;
            WrPatchSpot spot;
            bool theirs = wr_renderer_pick(renderer, x, y, &u, &v, &face);
            bool ours = wr_patch_pick_at(pick, x, y, &spot);
            hits += theirs;
            if (theirs != ours) differ++;
            if (!theirs || !ours) continue;
            double off = v3_len(
                v3_sub(point_of(scene, face, u, v), point_of(scene, spot.face, spot.u, spot.v)));
            if (off > 2e-3 * radius) differ++;
        }
        assert_true(hits > 500); /* of 11886 pixels; an upright patch set is a narrow strip */
        /* only along silhouettes */
        if (differ * 50 > hits)
            fail_msg("%s: %d of %d differ", wr_surfaces[kind]->name, differ, hits);
        wr_patch_pick_free(pick);
        wr_renderer_free(renderer);
        wr_scene_free(scene);
    }
    wr_pool_free(pool);
    wr_field_free(field);
}

static void beside_the_object_there_is_nothing(void **state)
{
    (void)state;
    WrScene *scene = scene_of((WrSurfaceKind)wr_surface_find("sphere"), false);
    WrPatchPick *pick = pick_of(scene);
    WrPatchSpot spot;
    assert_false(wr_patch_pick_at(pick, 1, 1, &spot));
    assert_false(wr_patch_pick_at(pick, W - 1, H / 2.0, &spot));
    assert_false(wr_patch_pick_at(pick, NAN, H / 2.0, &spot));
    assert_false(wr_patch_pick_at(pick, -1e300, 1e300, &spot));
    assert_true(wr_patch_pick_at(pick, W / 2.0, H / 2.0, &spot));
    wr_patch_pick_free(pick);
    wr_scene_free(scene);
}

static void the_back_of_a_sphere_is_hidden_and_its_front_is_not(void **state)
{
    (void)state;
    WrScene *scene = scene_of((WrSurfaceKind)wr_surface_find("sphere"), false);
    WrPatchPick *pick = pick_of(scene);
    WrPatchSpot front, spot;
    bool hidden;
    assert_true(wr_patch_pick_at(pick, W / 2.0 + 30, H / 2.0 - 12, &front));
    assert_true(wr_patch_pick_project(pick, 0, front.u, front.v, &spot, &hidden));
    assert_false(hidden);
    /* the opposite point: half a turn further, the other latitude */
    assert_true(
        wr_patch_pick_project(pick, 0, fmod(front.u + 0.5, 1), 1 - front.v, &spot, &hidden));
    assert_true(hidden);
    wr_patch_pick_free(pick);
    wr_scene_free(scene);
}

/* du/dx and so on against central differences of picks, whose error is of second order in the step. */
static void slopes_say_how_uv_move_with_the_pixel(void **state)
{
    (void)state;
    WrScene *scene = scene_of((WrSurfaceKind)wr_surface_find("torus"), false);
    WrPatchPick *pick = pick_of(scene);
    WrPatchSpot at, a, b;
    double j[4], worst[2] = { 0, 0 };
    const double x = W / 2.0 + 60, y = H / 2.0 + 45;
    assert_true(wr_patch_pick_at(pick, x, y, &at));
    assert_true(wr_patch_pick_slopes(pick, &at, j));
    for (int k = 0; k < 2; k++) {
        double step = k ? 0.5 : 1.0;
        assert_true(wr_patch_pick_at(pick, x - step, y, &a));
        assert_true(wr_patch_pick_at(pick, x + step, y, &b));
        worst[k] = fabs((b.u - a.u) / (2 * step) - j[0]) + fabs((b.v - a.v) / (2 * step) - j[2]);
        assert_true(wr_patch_pick_at(pick, x, y - step, &a));
        assert_true(wr_patch_pick_at(pick, x, y + step, &b));
        worst[k] += fabs((b.u - a.u) / (2 * step) - j[1]) + fabs((b.v - a.v) / (2 * step) - j[3]);
    }
    assert_true(worst[0] < 1e-3 * (fabs(j[0]) + fabs(j[1]) + fabs(j[2]) + fabs(j[3])));
    assert_true(worst[0] / worst[1] > 3.5 && worst[0] / worst[1] < 4.5);
    wr_patch_pick_free(pick);
    wr_scene_free(scene);
}

/* The unit square as a surface by a formula and as two triangles, whose picking is by rays. */
static void a_mesh_is_picked_as_the_same_surface_by_a_formula(void **state)
{
    (void)state;
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        WrScene *scenes[2];
        WrPatchPick *pick[2];
        for (int k = 0; k < 2; k++) {
            scenes[k] = scene_of(k ? WR_SURFACE_mesh : WR_SURFACE_plane, orthographic);
            if (k) wr_scene_set_triangles(scenes[k], wr_triangles_square(), NULL, NULL);
            scenes[k]->posed = true;
            scenes[k]->rotate_deg = (WrVec3){ -20, 12, 31 };
            scenes[k]->size = 1.7;
            pick[k] = pick_of(scenes[k]);
            assert_true(wr_patch_pick_is_mesh(pick[k]) == (k == 1));
        }
        int hits = 0;
        for (int k = 0; k < 500; k++) {
            const double x = random01() * W, y = random01() * H;
            WrPatchSpot a, b;
            double px, py;
            const bool hit = wr_patch_pick_at(pick[0], x, y, &a);
            assert_true(wr_patch_pick_at(pick[1], x, y, &b) == hit);
            if (!hit) continue;
            hits++;
            assert_near(a.u, b.u, 1e-7);
            assert_near(a.v, b.v, 1e-7);
            assert_near(a.depth, b.depth, 1e-7);
            assert_near(b.p.x, b.u, 1e-7); /* P = (u, v, 0) */
            assert_near(b.p.y, b.v, 1e-7);
            assert_near(b.along.x, 1, 1e-9);
            assert_true(wr_patch_pick_project_point(pick[1], b.p, &px, &py));
            assert_true(hypot(px - x, py - y) < 1e-6);
            const WrVec3 to = v3_sub(wr_patch_pick_eye(pick[1]), b.p);
            assert_true(v3_dot(to, b.n) > 0);
            WrPatchSpot beside; /* one pixel on, in the plane across the view at least as far */
            if (!wr_patch_pick_at(pick[1], x + 1e-3, y, &beside)) continue;
            assert_true(v3_len(v3_sub(beside.p, b.p)) > 0.99e-3 * b.pixel);
        }
        assert_true(hits > 100);
        for (int k = 0; k < 2; k++) {
            wr_patch_pick_free(pick[k]);
            wr_scene_free(scenes[k]);
        }
    }
}

/* The second object is a copy of the first, farther away by `back` radii. */
static int chosen_under_the_middle(int chosen, double back)
{
    WrError err = { "" };
    WrScene *one = scene_of((WrSurfaceKind)wr_surface_find("sphere"), false);
    WrScene *two = wr_scene_add_object(one, true);
    two->at.z = -back;
    WrScene *scene = wr_scene_choose(two, chosen);
    WrObjectPicks *picks = wr_object_picks_new(scene, TURN, W, H, NULL, &err);
    assert_non_null(picks);
    WrPatchSpot spot;
    const int found = wr_object_picks_at(picks, chosen, W / 2.0 + 7, H / 2.0 - 5, &spot);
    wr_object_picks_free(picks);
    wr_scene_free(scene);
    wr_scene_free(two);
    wr_scene_free(one);
    return found;
}

/* Two objects with relief on different materials of one mesh share its surface. */
static void of_coinciding_objects_the_chosen_one_is_picked(void **state)
{
    (void)state;
    assert_int_equal(chosen_under_the_middle(0, 0), 0);
    assert_int_equal(chosen_under_the_middle(1, 0), 1);
    assert_int_equal(chosen_under_the_middle(0, 0.3), 0);
    assert_int_equal(chosen_under_the_middle(1, 0.3), 0);
    assert_int_equal(chosen_under_the_middle(0, -0.3), 1);
}

static void a_camera_that_cannot_look_is_an_error(void **state)
{
    (void)state;
    WrError err = { "" };
    WrScene *scene = wr_scene_new();
    scene->camera.eye = scene->camera.target;
    scene->camera.fit = false;
    assert_null(wr_patch_pick_new(scene, 0, W, H, &err));
    assert_non_null(strstr(err.text, "eye"));
    wr_scene_free(scene);
    scene = wr_scene_new();
    assert_null(wr_patch_pick_new(scene, 0, 0, H, &err));
    wr_scene_free(scene);
}

/* From inside, or so near that most of the grid is behind the eye. */
static void hc82_an_eye_within_the_object_does_no_harm(void **state)
{
    (void)state;
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrScene *scene = scene_of((WrSurfaceKind)kind, false);
        scene->camera.fit = false;
        scene->camera.eye = (WrVec3){ 0.01, 0.02, 0.3 };
        WrPatchPick *pick = pick_of(scene);
        for (int k = 0; k < 200; k++) {
            WrPatchSpot spot;
            double x = random01() * W, y = random01() * H;
            if (!wr_patch_pick_at(pick, x, y, &spot)) continue;
            assert_true(spot.u >= 0 && spot.u <= 1 && spot.v >= 0 && spot.v <= 1);
            assert_true(hypot(spot.x - x, spot.y - y) < 1);
        }
        wr_patch_pick_free(pick);
        wr_scene_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_seen_is_found_under_its_pixel_on_every_surface),
        cmocka_unit_test(it_finds_what_the_renderer_shows_there),
        cmocka_unit_test(beside_the_object_there_is_nothing),
        cmocka_unit_test(the_back_of_a_sphere_is_hidden_and_its_front_is_not),
        cmocka_unit_test(slopes_say_how_uv_move_with_the_pixel),
        cmocka_unit_test(a_mesh_is_picked_as_the_same_surface_by_a_formula),
        cmocka_unit_test(of_coinciding_objects_the_chosen_one_is_picked),
        cmocka_unit_test(a_camera_that_cannot_look_is_an_error),
        cmocka_unit_test(hc82_an_eye_within_the_object_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
