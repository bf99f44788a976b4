/* The renderer at close range: the cone's tip, pictures of a millionth of the object, eyes at a millionth of its
   size, ground below the viewer. Objects of 1e-6 to 1e6 units, exact and fast arithmetic, every surface. */
#include "test.h"
#include "render_scenes.h"

#include "base/error.h"
#include "field/field.h"
#include "render/reference/reference.h"
#include "scene/scene.h"
#include "base/vec.h"

enum { SIZE = 48, PIXELS = SIZE * SIZE };

static const double scales[] = { 1e-6, 0.37, 1, 1e6 };

static void scale_shape(WrShape *shape, double by)
{
    int at = 0;
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    for (int p = 0; p < WR_SURFACE_PARAMS && info->params[p].name; p++)
        for (int i = 0; i < info->params[p].components; i++, at++)
            if (info->params[p].length) shape->value[at] *= by;
}

static WrScene *posed_scene(const char *surface, double scale)
{
    WrScene *scene = scene_of(surface);
    scene->posed = true;
    scale_shape(&scene->shape, scale);
    scene->height = 1e-4 * scale;
    return scene;
}

/* Unrotated: a camera right above stays there. */
static Shot shoot_straight(const WrScene *scene, const WrField *field, const char *isa)
{
    WrError err = { "" };
    Shot shot = { .renderer = wr_renderer_new(NULL, isa, &err) };
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIZE, .height = SIZE
    };
    if (!shot.renderer || !wr_renderer_frame(shot.renderer, &request, &shot.frame, &err))
        fail_msg("%s", err.text);
    return shot;
}

/* Every pixel is covered, in a picture of each arithmetic and in the reference. */
static void expect_whole(WrScene *scene, const WrField *field, const char *what, double size)
{
    static const char *const isas[] = { "ref", "auto" };
    for (int k = 0; k < 3; k++) {
        scene->dials.arithmetic = k == 2 ? WR_ARITHMETIC_FAST : WR_ARITHMETIC_EXACT;
        Shot shot = shoot_straight(scene, field, isas[k > 0]);
        if (shot.frame.covered != PIXELS)
            fail_msg("%s, %g, %s: %lld of %d pixels", what, size, k == 2 ? "fast" : isas[k],
                     (long long)shot.frame.covered, PIXELS);
        put_away(&shot);
    }
    WrReference reference = { 0 };
    WrError err = { "" };
    const WrReferenceRequest request = {
        .field = field, .scene = scene, .width = SIZE, .height = SIZE, .first = 1, .most = 1
    };
    if (!wr_reference_render(&request, NULL, &reference, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < PIXELS; i++)
        if (reference.rgba[4 * i + 3] != 1.0)
            fail_msg("%s, %g, reference: pixel %d,%d", what, size, i % SIZE, i / SIZE);
    wr_reference_fini(&reference);
}

/* From right above every ray hits the cone, however near to its axis. */
static void the_cones_tip_is_whole_from_above(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int s = 0; s < 4; s++)
        for (int k = 0; k <= 6; k++)
            for (int perspective = 0; perspective < 2; perspective++) {
                WrScene *scene = posed_scene("cone", scales[s]);
                const double size = pow(10, -k) * scales[s];
                const double away = perspective ? size : 5 * scales[s];
                scene->camera = (WrCamera){ .orthographic = !perspective,
                                            .eye = { 0, 0, 0.8 * scales[s] + away },
                                            .up = { 0, 1, 0 },
                                            .fov_deg = 20,
                                            .size = size };
                expect_whole(scene, field, perspective ? "from near" : "orthographic", size);
                wr_scene_free(scene);
            }
    wr_field_free(field);
}

/* A visible point of a surface, and its normal in world space, unrotated. */
static void place_of(const WrScene *scene, WrVec3 *p, WrVec3 *n, double *radius)
{
    WrPlacement place;
    WrSurfacePoint at;
    assert_true(wr_scene_place(scene, 0, 1, &place, NULL));
    const bool round = scene->shape.kind == WR_SURFACE_torus;
    wr_surface_at(&scene->shape, 0, 0.4375, round ? 0.0625 : 0.5625, &at);
    const WrVec3 w = v3_sub(at.p, place.centre);
    const double *m = place.rotation;
    *p = (WrVec3){ m[0] * w.x + m[1] * w.y + m[2] * w.z, m[3] * w.x + m[4] * w.y + m[5] * w.z,
                   m[6] * w.x + m[7] * w.y + m[8] * w.z };
    const WrVec3 a = at.n_unit;
    *n = (WrVec3){ m[0] * a.x + m[1] * a.y + m[2] * a.z, m[3] * a.x + m[4] * a.y + m[5] * a.z,
                   m[6] * a.x + m[7] * a.y + m[8] * a.z };
    *radius = place.radius;
}

/* True if it has a size, and its centre scales with it. */
static bool grows(const WrSurfaceInfo *info)
{
    return !info->unit_sized && info->centre[0] == 0 && info->centre[1] == 0;
}

/* Views straight at a point: through a window of 10^-k radii, and from a distance of 10^-k radii. Curved surfaces are
   found through a grid of cells, whose chords have an error of about 1e-5 radii: eyes are no closer to those. */
static void every_surface_fills_the_picture_from_close_by(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++)
        for (int s = 0; s < 4; s++)
            for (int k = 2; k <= 6; k++)
                for (int perspective = 0; perspective < 2; perspective++) {
                    const bool mesh = wr_surfaces[kind]->inversion == WR_INVERT_MESH;
                    if (!grows(wr_surfaces[kind]) && s != 2) continue;
                    if ((kind + s + k + perspective) % test_step(3, 5) != 0) continue;
                    if (perspective && mesh && k > 3) continue;
                    WrScene *scene = posed_scene(wr_surfaces[kind]->name, scales[s]);
                    WrVec3 p, n;
                    double radius;
                    place_of(scene, &p, &n, &radius);
                    const double size = pow(10, -k) * radius;
                    scene->camera =
                        (WrCamera){ .orthographic = !perspective,
                                    .eye = v3_mad(p, n, perspective ? size : 3 * radius),
                                    .target = p,
                                    .up = { 0.3, 0.2, 0.9 },
                                    .fov_deg = 60,
                                    .size = size };
                    expect_whole(scene, field, wr_surfaces[kind]->name, size);
                    wr_scene_free(scene);
                }
    wr_field_free(field);
}

/* An eye 0.5 above level ground: a pixel shows it if its ray goes down. The same ground as a bent patch uses cells,
   clipping and Newton's method. */
static void ground_is_seen_down_to_ones_feet(void **state)
{
    (void)state;
    static const double sides[] = { 10, 2e5, 2e7 };
    WrField *field = bumpy_field(16, 16);
    for (int k = 0; k < 6; k++)
        for (int fast = 0; fast < 2; fast++) {
            const double side = sides[k / 2];
            WrScene *scene = posed_scene(k % 2 ? "bent" : "plane", side);
            if (k % 2) scene->shape.value[2] = scene->shape.value[3] = scene->shape.value[4] = 0;
            scene->shape.value[0] = scene->shape.value[1] = side;
            scene->dials.arithmetic = fast ? WR_ARITHMETIC_FAST : WR_ARITHMETIC_EXACT;
            scene->camera = (WrCamera){
                .eye = { 0, 0, 0.5 }, .target = { 0, 0.5, 0 }, .up = { 0, 0, 1 }, .fov_deg = 120
            };
            Shot shot = shoot_straight(scene, field, "auto");
            for (int y = 0; y < SIZE; y++) {
                const double tilt = (1 - (2 * y + 1.0) / SIZE) * sqrt(3);
                const double down = (1 - tilt) * sqrt(0.5), ahead = (1 + tilt) * sqrt(0.5);
                const bool seen = down > 0 && 0.5 / down * fmax(ahead, 1.8) < 0.49 * side;
                const bool edge = down > 0 && !seen;
                const double got = (double)shot.frame.rgba[4 * (y * SIZE + SIZE / 2) + 3];
                if (!edge && got != (seen ? 1 : 0))
                    fail_msg("ground of %g%s, row %d: %g", side, k % 2 ? " in cells" : "", y, got);
            }
            put_away(&shot);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_cones_tip_is_whole_from_above),
        cmocka_unit_test(every_surface_fills_the_picture_from_close_by),
        cmocka_unit_test(ground_is_seen_down_to_ones_feet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
