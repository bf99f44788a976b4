/* Cast shadows between objects and self-shadowing: pictures against closed forms and against the reference, which
   intersects its own rays with the objects' exact shapes. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"
#include "mesh_grids.h"

#include "field/horizon.h"
#include "render/reference/reference.h"
#include "scene/objects.h"
#include "surface/triangles.h"

#define SIDE 96

static WrScene *bare(const char *surface)
{
    WrShape shape;
    WrScene *scene = wr_scene_new();
    wr_shape_default((WrSurfaceKind)wr_surface_find(surface), &shape);
    wr_scene_set_shape(scene, &shape);
    scene->bump = WR_BUMP_NONE;
    scene->height = 0;
    scene->material.specular = 0, scene->material.ambient = 0, scene->material.diffuse = 1;
    scene->material.colour = (WrVec3){ 1, 1, 1 };
    scene->lights[0].shadow = true;
    return scene;
}

/* The ground and another object in one scene, seen from straight above. */
static WrScene *above_ground(const char *surface, WrVec3 at, double size)
{
    WrScene *ground = bare("plane");
    ground->shape.value[0] = ground->shape.value[1] = 4;
    ground->posed = true;
    ground->camera.fit = false, ground->camera.orthographic = true, ground->camera.size = 4;
    ground->camera.eye = (WrVec3){ 0, 0, 9 };
    ground->camera.target = (WrVec3){ 0, 0, 0 };
    ground->camera.up = (WrVec3){ 0, 1, 0 };
    WrScene *both = wr_scene_add_object(ground, false);
    WrShape shape;
    wr_shape_default((WrSurfaceKind)wr_surface_find(surface), &shape);
    wr_scene_set_shape(both, &shape);
    both->bump = WR_BUMP_NONE, both->height = 0, both->posed = true;
    both->material = ground->material;
    both->at = at, both->size = size;
    wr_scene_free(ground);
    return both;
}

static Shot shot_on(const WrScene *scene, const WrField *field, const WrForce *force)
{
    WrError err = { "" };
    Shot shot = { .pool = wr_pool_new(2) };
    shot.renderer = wr_renderer_new(shot.pool, "auto", &err);
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .force = force
    };
    if (!wr_renderer_frame(shot.renderer, &request, &shot.frame, &err)) fail_msg("%s", err.text);
    return shot;
}

static Shot shot_of(const WrScene *scene, const WrForce *force)
{
    WrField *field = bumpy_field(17, 11);
    const Shot shot = shot_on(scene, field, force);
    wr_field_free(field);
    return shot;
}

/* Position of a pixel's centre on the ground. */
static WrVec3 ground_at(int k)
{
    return (WrVec3){ ((k % SIDE + 0.5) / SIDE - 0.5) * 4, (0.5 - (k / SIDE + 0.5) / SIDE) * 4, 0 };
}

/* A sphere hides a light where the line to it passes closer to the centre than its radius. */
static void a_balls_shadow_is_an_ellipse(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        const WrVec3 at = { -0.371, 0.213, 0.83 };
        WrScene *scene = above_ground("sphere", at, 0.437);
        WrLight *lamp = &scene->lights[0];
        lamp->kind = kind ? WR_LIGHT_POINT : WR_LIGHT_DIRECTIONAL;
        lamp->where = kind ? (WrVec3){ -0.7, 0.66, 2.9 } : (WrVec3){ -0.717, -0.293, 0.819 };
        Shot shot = shot_of(scene, NULL);
        int dark = 0, lit = 0;
        for (int k = 0; k < SIDE * SIDE; k++) {
            const WrVec3 p = ground_at(k);
            const WrVec3 off = v3_sub(at, p), up = { 0, 0, 1 };
            if (off.x * off.x + off.y * off.y < 0.45 * 0.45)
                continue; /* the sphere itself is visible */
            const WrVec3 l = v3_unit(kind ? v3_sub(lamp->where, p) : lamp->where, up);
            const double along = v3_dot(off, l), by = sqrt(v3_dot(off, off) - along * along);
            if (fabs(by - 0.437) < 1e-4) continue;
            const bool hidden = by < 0.437;
            if ((shot.frame.rgba[4 * k] == 0) != hidden)
                fail_msg("lamp %d at %g %g: %g", kind, p.x, p.y, (double)shot.frame.rgba[4 * k]);
            dark += hidden, lit += !hidden;
        }
        assert_true(dark > 300 && lit > 3000);
        put_away(&shot);
        wr_scene_free(scene);
    }
}

/* From far along the line to the light, onto a small object. */
static void far_bodies_reach(void **state)
{
    (void)state;
    const WrVec3 at = { 3.1, -2.2, 6.4 };
    for (int kind = 0; kind < 2; kind++) {
        WrScene *scene = above_ground("sphere", at, 0.21);
        WrScene *ground = wr_scene_choose(scene, 0);
        ground->shape.value[0] = ground->shape.value[1] = 0.9;
        ground->lights[0].kind = kind ? WR_LIGHT_POINT : WR_LIGHT_DIRECTIONAL;
        ground->lights[0].where = kind ? v3_scale(at, 4) : at;
        Shot shot = shot_of(ground, NULL);
        const float *middle = shot.frame.rgba + 4 * (SIDE * (SIDE / 2) + SIDE / 2);
        assert_true(middle[3] == 1 && middle[0] == 0);
        assert_true(middle[4 * 8] > 0);
        put_away(&shot);
        wr_scene_free(ground);
        wr_scene_free(scene);
    }
}

/* The edge of a wide board is straight: the visible part of a round light is a segment of its disc. */
static void a_boards_edge_has_the_penumbra_of_a_disc(void **state)
{
    (void)state;
    const double edge = 0.113, above = 0.71, radius = 4.3 * WR_PI / 180;
    WrScene *scene = above_ground("plane", (WrVec3){ edge + 40, 0, above }, 80);
    scene->lights[0].where = (WrVec3){ 0, 0, 1 };
    scene->lights[0].size_deg = 4.3;
    scene->dials.rays = 256;
    scene->camera.eye = (WrVec3){ 0.2, 0, 0.5 }; /* below the board */
    scene->camera.target = (WrVec3){ 0.2, 0, 0 };
    Shot shot = shot_of(scene, NULL);
    double worst = 0;
    int half = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double x = edge - (ground_at(k).x + 0.2), angle = atan2(x, above);
        const double t = fmin(fmax(tan(angle) / tan(radius), -1), 1);
        const double want = 0.5 + (t * sqrt(1 - t * t) + asin(t)) / WR_PI;
        if (shot.frame.rgba[4 * k + 3] < 1) continue;
        worst = fmax(worst, fabs((double)shot.frame.rgba[4 * k] - want));
        half += want > 0.1 && want < 0.9;
    }
    print_message("penumbra: %g off over %d pixels\n", worst, half);
    assert_true(half > 60);
    assert_true(worst < 0.013);
    put_away(&shot);
    wr_scene_free(scene);
}

/* Fractions of covered pixels: in shadow, and different from the reference by over a hundredth. */
static void compare(const WrScene *scene, double *dark, double *off)
{
    WrField *field = bumpy_field(17, 11);
    WrScene *without = wr_scene_clone(scene);
    without->lights[0].shadow = without->material.shadow = false;
    for (int i = 0; i < without->other_count; i++) without->others[i]->material.shadow = false;
    Shot shot = shot_of(scene, NULL), plain = shot_of(without, NULL);
    WrReference truth = { 0 };
    WrError err = { "" };
    const WrReferenceRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .first = 1, .most = 1
    };
    if (!wr_reference_render(&request, NULL, &truth, &err)) fail_msg("%s", err.text);
    int covered = 0, hidden = 0, other = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        const float *a = shot.frame.rgba + 4 * k;
        if (a[3] < 1 || truth.rgba[4 * k + 3] < 1) continue;
        covered++;
        hidden += a[0] < plain.frame.rgba[4 * k];
        other += fabs((double)a[0] - truth.rgba[4 * k]) > 0.01;
    }
    *dark = (double)hidden / covered, *off = (double)other / covered;
    wr_reference_fini(&truth);
    wr_field_free(field);
    put_away(&shot);
    put_away(&plain);
    wr_scene_free(without);
}

static void objects_shadow_themselves_as_the_reference_has_it(void **state)
{
    const char *const surfaces[] = { "torus", "cylinder", "cone", "bent", "curl", "revolution" };
    const double least[] = { 0.01, 0.02, 0, 0, 0.02, 0 };
    (void)state;
    for (int s = 0; s < 6; s++) {
        double dark, off;
        WrScene *scene = bare(surfaces[s]);
        scene->posed = true, scene->rotate_deg = (WrVec3){ s ? -47 : 35, s ? 13 : 20, 9 };
        scene->lights[0].where = (WrVec3){ -0.83, 0.41, 0.33 };
        compare(scene, &dark, &off);
        print_message("%s: %g hidden, %g off\n", surfaces[s], dark, off);
        assert_true(dark >= least[s]);
        assert_true(off < 0.004);
        wr_scene_free(scene);
    }
}

/* Stretched, rotated, scaled, mirrored: positions of one object in another's space. */
static void objects_shadow_one_another_as_the_reference_has_it(void **state)
{
    const char *const surfaces[] = { "torus", "cube", "cylinder", "cone" };
    (void)state;
    for (int s = 0; s < 4; s++) {
        double dark, off;
        WrScene *scene = above_ground(surfaces[s], (WrVec3){ 0.17, -0.31, 0.9 }, 0.53);
        scene->rotate_deg = (WrVec3){ 33, -21, 57 };
        scene->sizes = (WrVec3){ 0.7, 1.3, s == 2 ? -0.9 : 1.1 };
        scene->lights[0].where = (WrVec3){ -0.5, 0.31, 0.6 };
        scene->camera.eye = (WrVec3){ 1, -3, 6 };
        compare(scene, &dark, &off);
        print_message("%s: %g hidden, %g off\n", surfaces[s], dark, off);
        assert_true(dark > 0.015);
        assert_true(off < 0.004);
        wr_scene_free(scene);
    }
}

/* A coarsely triangulated sphere with smooth shading never shadows itself: no facet is dark where the normals are
   lit. */
static void facets_throw_no_steps_on_a_round_body(void **state)
{
    (void)state;
    WrScene *scene = bare("mesh");
    WrTriangles *ball = mesh_grid(on_sphere, 17, 9, false);
    wr_scene_set_triangles(scene, ball, "ball", "0");
    scene->lights[0].where = (WrVec3){ -0.93, 0.21, 0.13 };
    Shot shot = shot_of(scene, NULL);
    scene->lights[0].shadow = false;
    Shot plain = shot_of(scene, NULL);
    assert_true(shot.frame.plan->rows[WR_EFFECT_CAST].ran);
    assert_true(shot.frame.covered > 1000);
    assert_true(same_picture(&shot, &plain));
    put_away(&shot);
    put_away(&plain);
    wr_scene_free(scene);
}

/* Skipping tests by a proof leaves the picture bit-identical. */
static void what_cannot_reach_is_left_out(void **state)
{
    (void)state;
    WrForce all[WR_EFFECT_COUNT] = { WR_FORCE_NONE };
    all[WR_EFFECT_CAST] = WR_FORCE_ON;
    for (int s = 0; s < 2; s++) {
        WrScene *scene = above_ground(s ? "sphere" : "cube", (WrVec3){ 1.2, 0.4, -2.5 }, 0.3);
        scene->lights[0].where = s ? (WrVec3){ 3, 1, 4 } : (WrVec3){ 0.3, 0.2, 0.9 };
        scene->lights[0].kind = s ? WR_LIGHT_POINT : WR_LIGHT_DIRECTIONAL;
        scene->camera.eye = (WrVec3){ 1, -7, 2 };
        WrScene *ground = wr_scene_choose(scene, 0);
        ground->at = (WrVec3){ -2.3, 0, 0 };
        Shot shot = shot_of(ground, NULL), forced = shot_of(ground, all);
        assert_false(shot.frame.plan->rows[WR_EFFECT_CAST].run);
        assert_true(forced.frame.plan->rows[WR_EFFECT_CAST].ran);
        assert_non_null(strstr(shot.frame.plan->rows[WR_EFFECT_CAST].reason, "bounding sphere"));
        assert_true(same_picture(&shot, &forced));
        put_away(&shot);
        put_away(&forced);
        wr_scene_free(scene);
        wr_scene_free(ground);
    }
}

/* Lights of intensity 0 get no samples: the others keep their own softness. */
static void dark_lamps_change_no_other(void **state)
{
    (void)state;
    WrScene *scene = above_ground("sphere", (WrVec3){ 0.2, 0.1, 0.9 }, 0.4);
    scene->lights[0].where = (WrVec3){ 0.5, 0.3, 0.8 };
    scene->lights[0].size_deg = 5;
    Shot one = shot_of(scene, NULL);
    const WrLight soft = scene->lights[0];
    scene->lights = wr_realloc(scene->lights, 1, 2, sizeof *scene->lights);
    scene->light_count = 2;
    scene->lights[0].strength = 0, scene->lights[0].size_deg = 0;
    scene->lights[1] = soft;
    Shot two = shot_of(scene, NULL);
    assert_true(same_picture(&one, &two));
    put_away(&one);
    put_away(&two);
    wr_scene_free(scene);
}

/* ---- displaced ---- */

/* With height c everywhere a sphere casts the shadow of a sphere with radius R + c. */
static void a_raised_ball_throws_its_own_shadow(void **state)
{
    (void)state;
    static const double rise[] = { 0.213, -0.317 };
    for (int k = 0; k < 2; k++) {
        const WrVec3 at = { -0.371, 0.213, 0.93 };
        WrScene *scene = above_ground("sphere", at, 0.437);
        WrField *field =
            wr_field_new(5, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, (float)rise[k], NULL);
        scene->displaced = true, scene->height = 1;
        scene->lights[0].where = (WrVec3){ -0.717, -0.293, 0.519 };
        Shot shot = shot_on(scene, field, NULL);
        const double radius = 0.437 * (1 + rise[k]);
        int dark = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const WrVec3 off = v3_sub(at, ground_at(i));
            if (hypot(off.x, off.y) < radius + 0.05) continue; /* the sphere itself is visible */
            const WrVec3 l = v3_unit(scene->lights[0].where, (WrVec3){ 0, 0, 1 });
            const double along = v3_dot(off, l), by = sqrt(v3_dot(off, off) - along * along);
            if (fabs(by - radius) < 2e-3) continue;
            if ((shot.frame.rgba[4 * i] == 0) != (by < radius))
                fail_msg("%g: %g from the middle of the shadow", rise[k], by);
            dark += by < radius;
        }
        assert_true(dark > 120);
        put_away(&shot);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* With height c everywhere a square mesh casts the shadow of that square c higher; the first is the mesh without a file. */
static void a_raised_mesh_throws_its_own_shadow(void **state)
{
    (void)state;
    static const double rise[] = { 0.613, -0.517 };
    for (int k = 0; k < 2; k++) {
        const double size = 0.837;
        const WrVec3 at = { 0.371, -0.913, 0.93 }, top = { at.x, at.y, at.z + size * rise[k] };
        WrScene *scene = above_ground("mesh", at, size);
        if (k) wr_scene_set_triangles(scene, wr_triangles_square(), "a.obj", NULL);
        scene->rotate_deg = (WrVec3){ 0, 0, 0 };
        WrField *field =
            wr_field_new(5, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, (float)rise[k], NULL);
        scene->displaced = true, scene->height = 1;
        scene->lights[0].where = (WrVec3){ 0.417, -0.293, 0.519 };
        const WrVec3 l = v3_unit(scene->lights[0].where, (WrVec3){ 0, 0, 1 });
        Shot shot = shot_on(scene, field, NULL);
        int dark = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const WrVec3 g = ground_at(i), seen = v3_sub(g, at);
            if (fmax(fabs(seen.x), fabs(seen.y)) < 0.55 * size) continue;
            const WrVec3 hit = v3_sub(v3_mad(g, l, top.z / l.z), top);
            const double inside = size / 2 - fmax(fabs(hit.x), fabs(hit.y));
            if (fabs(inside) < 2e-3) continue;
            if ((shot.frame.rgba[4 * i] == 0) != (inside > 0))
                fail_msg("%g: %g inside the shadow", rise[k], inside);
            dark += inside > 0;
        }
        assert_true(dark > 120);
        put_away(&shot);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* A sphere with a relief too low to be visible is as bright as one without displacement. */
static void a_relief_too_low_to_be_seen_darkens_nothing(void **state)
{
    (void)state;
    static const double rise[] = { 0.004, -0.004 };
    for (int k = 0; k < 2; k++) {
        WrScene *scene = above_ground("sphere", (WrVec3){ 0.1, -0.2, 0.93 }, 0.437);
        WrField *field =
            wr_field_new(5, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, (float)rise[k], NULL);
        scene->displaced = true, scene->height = 1;
        Shot shot = shot_on(scene, field, NULL);
        scene->displaced = false;
        Shot plain = shot_on(scene, field, NULL);
        int other = 0;
        for (int i = 0; i < SIDE * SIDE; i++)
            other += fabs((double)(shot.frame.rgba[4 * i] - plain.frame.rgba[4 * i])) > 0.05;
        print_message("%d of %d pixels differ\n", other, SIDE * SIDE);
        assert_true(other < 40); /* silhouette pixels; the sphere has 290 */
        put_away(&shot);
        put_away(&plain);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* If displacement is forced off, or the table moves nothing, the sphere is shown as its base: lights are then hidden
   by bases too. */
static void what_is_shown_undisplaced_throws_its_bases_shadow(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        WrForce force[WR_EFFECT_COUNT] = { WR_FORCE_NONE };
        WrScene *scene = above_ground("sphere", (WrVec3){ 0.1, -0.2, 0.93 }, 0.437);
        WrField *field = bumpy_field(16, 16);
        if (k) wr_field_fill(field, 0);
        else force[WR_EFFECT_DISPLACED] = WR_FORCE_OFF;
        scene->displaced = true, scene->height = 0.113;
        Shot shot = shot_on(scene, field, force);
        scene->displaced = false;
        Shot plain = shot_on(scene, field, NULL);
        assert_true(same_picture(&shot, &plain));
        put_away(&shot);
        put_away(&plain);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* Shadows on the ground and on the objects themselves; if the relief's own shadow is on, rays include both. */
static void raised_objects_shadow_as_the_reference_has_it(void **state)
{
    static const char *const surfaces[] = { "torus", "sphere" };
    (void)state;
    for (int s = 0; s < 2; s++) {
        double dark, off;
        WrScene *scene =
            s ? bare(surfaces[s]) : above_ground(surfaces[s], (WrVec3){ 0.17, -0.31, 0.9 }, 0.53);
        scene->posed = true, scene->rotate_deg = (WrVec3){ 33, -21, 57 };
        scene->displaced = true, scene->height = 0.13;
        scene->bump = WR_BUMP_EXACT, scene->scheme = WR_SCHEME_BSPLINE_FIT;
        scene->material.shadow = true;
        scene->lights[0].where = (WrVec3){ -0.5, 0.31, 0.37 };
        scene->dials.dice = 0.125;
        if (!s) scene->camera.eye = (WrVec3){ 1, -3, 6 };
        compare(scene, &dark, &off);
        print_message("displaced %s: %g hidden, %g off\n", surfaces[s], dark, off);
        assert_true(dark > 0.03);
        assert_true(off < 0.012);
        wr_scene_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_balls_shadow_is_an_ellipse),
        cmocka_unit_test(far_bodies_reach),
        cmocka_unit_test(a_boards_edge_has_the_penumbra_of_a_disc),
        cmocka_unit_test(objects_shadow_themselves_as_the_reference_has_it),
        cmocka_unit_test(objects_shadow_one_another_as_the_reference_has_it),
        cmocka_unit_test(facets_throw_no_steps_on_a_round_body),
        cmocka_unit_test(what_cannot_reach_is_left_out),
        cmocka_unit_test(dark_lamps_change_no_other),
        cmocka_unit_test(a_raised_ball_throws_its_own_shadow),
        cmocka_unit_test(a_raised_mesh_throws_its_own_shadow),
        cmocka_unit_test(a_relief_too_low_to_be_seen_darkens_nothing),
        cmocka_unit_test(what_is_shown_undisplaced_throws_its_bases_shadow),
        cmocka_unit_test(raised_objects_shadow_as_the_reference_has_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
