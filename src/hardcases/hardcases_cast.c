/* Hard cases of shadows between objects. */
#include "hardcases/hardcases_internal.h"

#include "field/field.h"
#include "scene/objects.h"
#include "surface/triangles.h"

#define SIDE 16

static WrScene *alone(const char *surface)
{
    WrScene *scene = wr_scene_new();
    WrShape shape;
    wr_shape_default((WrSurfaceKind)wr_surface_find(surface), &shape);
    wr_scene_set_shape(scene, &shape);
    scene->bump = WR_BUMP_NONE;
    scene->material.specular = 0;
    return scene;
}

/* Number of pixels of a convex body that change if its own shadow is computed although the plan leaves it out. */
static bool changes(WrHardGauge *g, WrScene *scene, WrHardPrecision precision, WrError *err)
{
    WrForce force[WR_EFFECT_COUNT] = { WR_FORCE_NONE };
    WrHardShot with, without;
    WrField *field = wr_field_new(4, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
    WrFrameRequest request = { .field = field, .scene = scene, .width = 41, .height = 37 };
    force[WR_EFFECT_CAST] = WR_FORCE_ON;
    scene->lights[0].shadow = false;
    bool good = field && wr_hard_shoot(g, &request, &without, err);
    scene->lights[0].shadow = true;
    request.force = force;
    if (good && wr_hard_shoot(g, &request, &with, err)) {
        wr_hard_off(g, precision, (double)wr_hard_differ(&with, &without, 0));
        wr_hard_put_away(&with);
        wr_hard_put_away(&without);
    } else {
        good = false;
    }
    wr_field_free(field);
    return good;
}

static bool hc190(WrHardGauge *g, WrError *err)
{
    static const char *const surfaces[] = { "sphere", "capsule", "cube", "plane" };
    bool good = true;
    for (int i = 0; i < 12 && good; i++) {
        if (i % 4 == 1 && i != 5) continue; /* facets are slow */
        WrScene *scene = alone(surfaces[i % 4]);
        scene->size = i / 4 == 0 ? 1e-4 : i / 4 == 1 ? 0.87 : 3e4;
        scene->posed = true;
        scene->rotate_deg = (WrVec3){ wr_hard_between(g, -180, 180), 10, 20 };
        scene->lights[0].where = (WrVec3){ wr_hard_between(g, -1, 1), 0.3, 0.15 };
        if (i == 5) scene->sizes = (WrVec3){ 1, 0.4, 2.3 };
        if (i % 3 == 0) scene->dials.shading = WR_SHADING_DOUBLE;
        good = changes(g, scene, i % 3 == 0 ? WR_HARD_DOUBLE : WR_HARD_FLOAT, err);
        wr_scene_free(scene);
    }
    return good;
}

/* A square of two triangles above the ground, with the camera between: rays to a lamp straight above pass
   through the common edge, and through the corners. */
static WrScene *roofed(WrHardGauge *g, double shift)
{
    WrScene *ground = alone("plane");
    ground->shape.value[0] = ground->shape.value[1] = 4;
    ground->posed = true;
    ground->camera.fit = false, ground->camera.orthographic = true;
    ground->camera.eye = (WrVec3){ 0, 0, 0.3 }, ground->camera.target = (WrVec3){ 0, 0, 0 };
    /* pixel centres are at multiples of 1/16, except for the shift */
    ground->camera.size = 1 - 1.0 / SIDE;
    ground->lights[0].where = (WrVec3){ 0, 0, 1 };
    ground->lights[0].shadow = true;
    ground->material.ambient = 0;
    WrScene *both = wr_scene_add_object(ground, false);
    wr_scene_set_triangles(both, wr_triangles_square(), NULL, NULL);
    both->posed = true;
    both->at = (WrVec3){ shift, shift, wr_hard_between(g, 0.5, 2) };
    wr_scene_free(ground);
    return both;
}

static bool hc191(WrHardGauge *g, WrError *err)
{
    bool good = true;
    for (int i = 0; i < 6 && good; i++) {
        WrScene *scene = roofed(g, i < 3 ? 0 : wr_hard_between(g, -1e-3, 1e-3));
        WrField *field = wr_field_new(4, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIDE - 1, .height = SIDE - 1
        };
        WrHardShot shot;
        good = field && wr_hard_shoot_by(g, &request, (WrHardWay)(i % 3), &shot, err);
        for (int k = 0; good && k < (SIDE - 1) * (SIDE - 1); k++) {
            const WrHardPrecision precision =
                i % 3 == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
            wr_hard_holds(g, precision, shot.frame.rgba[4 * k + 3] == 1);
            wr_hard_holds(g, precision, shot.frame.rgba[4 * k] == 0);
        }
        if (good) wr_hard_put_away(&shot);
        wr_field_free(field);
        wr_scene_free(scene);
    }
    return good;
}

static const WrHardCase rows[] = {
    { .id = "HC190",
      .subject = WR_HARD_RENDER,
      .what = "lamps along convex bodies of any size, in closed form and of facets",
      .holds = "they hide no lamp from themselves: the picture without shadows, to the bit",
      .unit = "values",
      .bound = { 0, 0 },
      .measure = hc190,
      .scene = "surface capsule\nlight directional to=1,0.3,0.02 shadow=on" },
    { .id = "HC191",
      .subject = WR_HARD_RENDER,
      .what = "a lamp whose rays go along the edge that two triangles share",
      .holds = "no light between them",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = hc191,
      .scene = "surface plane\nlight directional to=0,0,1 shadow=on" },
};
WR_HARD_LIST(cast, rows);
