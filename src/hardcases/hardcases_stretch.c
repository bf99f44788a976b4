/* Hard cases of objects in a scene: stretched, mirrored, flat, far away. */
#include "hardcases/hardcases_stretch.h"

#include "base/memory.h"
#include "base/vec.h"
#include "field/field.h"
#include "scene/objects.h"

#include <string.h>

#define SIDE 48 /* pixels */
#define VIEW 2.4
#define WHOLE 0.9 /* of the distance to the outline, squared: the tested area */

/* An ellipsoid of those sizes, seen along its z axis. */
static WrScene *ball_of(WrVec3 sizes)
{
    WrScene *scene = wr_scene_new();
    WrShape shape;
    wr_shape_default(WR_SURFACE_sphere, &shape);
    shape.value[0] = 1;
    wr_scene_set_shape(scene, &shape);
    scene->sizes = sizes;
    scene->size = fmax(fabs(sizes.x), fmax(fabs(sizes.y), fabs(sizes.z)));
    scene->posed = true;
    scene->height = 0;
    scene->camera = (WrCamera){
        .orthographic = true, .eye = { 0, 0, 1000 }, .up = { 0, 1, 0 }, .fov_deg = 35, .size = VIEW
    };
    return scene;
}

static double half_axis(double size, double largest)
{
    return fmax(fabs(size), WR_THINNEST * largest);
}

/* n of the ellipsoid x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 at a pixel's centre, facing the viewer; false near its
   outline. */
static bool ellipsoid(const WrScene *scene, int i, WrVec3 *n)
{
    const double a = half_axis(scene->sizes.x, scene->size);
    const double b = half_axis(scene->sizes.y, scene->size);
    const double c = half_axis(scene->sizes.z, scene->size);
    const double x = ((i % SIDE + 0.5) / SIDE - 0.5) * VIEW / a;
    const double y = (0.5 - (i / SIDE + 0.5) / SIDE) * VIEW / b, left = 1 - x * x - y * y;
    if (left < 1 - WHOLE) return false;
    *n = v3_unit((WrVec3){ x / a, y / b, sqrt(left) / c }, (WrVec3){ 0, 0, 1 });
    return true;
}

static void look(WrHardGauge *g, WrHardPrecision precision, const WrScene *scene,
                 const float *normals, double bound)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        const WrVec3 got = { normals[3 * i], normals[3 * i + 1], normals[3 * i + 2] };
        WrVec3 want;
        if (ellipsoid(scene, i, &want))
            wr_hard_holds(g, precision, v3_len(got) > 0.5 && v3_angle_rad(got, want) < bound);
    }
}

/* In every arithmetic, and by the reference. */
static bool try_ball(WrHardGauge *g, WrVec3 sizes, WrError *err)
{
    WrScene *scene = ball_of(sizes);
    WrField *field = wr_hard_waves(16, 16);
    float normals[3 * SIDE * SIDE];
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .normals = normals
    };
    bool good = true;
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot;
        const WrHardPrecision precision = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
        memset(normals, 0, sizeof normals);
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
        if (!good) break;
        look(g, precision, scene, normals, 2e-3);
        wr_hard_holds(g, precision, wr_hard_wild(&shot) == 0);
        wr_hard_put_away(&shot);
    }
    WrReference reference = { 0 };
    good = good && wr_hard_refer(g, &request, 1, &reference, err);
    for (int i = 0; i < 3 * SIDE * SIDE && good; i++) normals[i] = (float)reference.normal[i];
    if (good) look(g, WR_HARD_DOUBLE, scene, normals, 1e-5);
    wr_reference_fini(&reference);
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

static bool try_balls(WrHardGauge *g, const WrVec3 *sizes, int count, WrError *err)
{
    bool good = true;
    for (int i = 0; i < count && good; i++) good = try_ball(g, sizes[i], err);
    return good;
}

bool wr_hard_hc33(WrHardGauge *g, WrError *err)
{
    static const WrVec3 sizes[] = { { 1, 1, 100 }, { 100, 1, 1 }, { 0.8, 0.008, 0.8 } };
    return try_balls(g, sizes, 3, err);
}

bool wr_hard_hc34(WrHardGauge *g, WrError *err)
{
    static const WrVec3 sizes[] = { { -1, 1, 1 }, { 0.7, -1, 0.9 }, { 1, 1, -1 }, { -1, -1, -1 } };
    return try_balls(g, sizes, 4, err);
}

bool wr_hard_hc153(WrHardGauge *g, WrError *err)
{
    static const WrVec3 sizes[] = { { 1, 1, -100 }, { 1, 1, 0 }, { 1, 1, -0.0 },
                                    { 0, 1, 1 },    { 0, 1, 0 }, { -1, 0, -0.5 } };
    return try_balls(g, sizes, 6, err);
}

/* ---- far away ---- */

/* A sphere and a box, 1 apart, and the eye, all moved by `far`. */
static WrScene *pair_at(double far)
{
    WrScene *first = ball_of((WrVec3){ 0 });
    first->size = 0.4;
    first->at = (WrVec3){ far - 0.5, far, 0 };
    WrScene *scene = wr_scene_add_object(first, false);
    WrShape shape;
    wr_scene_free(first);
    wr_shape_default(WR_SURFACE_cube, &shape);
    wr_scene_set_shape(scene, &shape);
    scene->size = 0.5;
    scene->at = (WrVec3){ far + 0.5, far, 0 };
    scene->height = 0;
    scene->camera = (WrCamera){ .eye = { far + 0.7, far + 0.9, 4 },
                                .target = { far, far, 0 },
                                .up = { 0, 1, 0 },
                                .fov_deg = 35 };
    return scene;
}

bool wr_hard_hc154(WrHardGauge *g, WrError *err)
{
    enum { WIDE = 200 }; /* the outlines are about 500 pixels: moved by 2^-8 of one, 2 change */
    WrField *field = wr_hard_waves(16, 16);
    WrScene *near = pair_at(0), *far = pair_at(1e7);
    bool good = true;
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot a, b;
        const WrHardPrecision precision = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
        WrFrameRequest request = { .field = field, .scene = near, .width = WIDE, .height = WIDE };
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &a, err);
        if (!good) break;
        request.scene = far;
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &b, err);
        if (good) {
            int object = -1, face;
            double u, v;
            wr_hard_holds(g, precision, wr_hard_differ(&a, &b, 0.01) <= 16);
            wr_hard_holds(g, precision,
                          wr_renderer_pick_object(b.renderer, 60, 110, &object, &u, &v, &face) &&
                              object == 0);
            wr_hard_put_away(&b);
        }
        wr_hard_put_away(&a);
    }
    wr_field_free(field);
    wr_scene_free(near);
    wr_scene_free(far);
    return good;
}

static const WrHardCase rows[] = {
    { .id = "HC153",
      .subject = WR_HARD_GEOMETRY,
      .what = "an object mirrored and stretched a hundredfold, or flat",
      .holds =
          "n keeps to its side: by the cofactors, with the determinant's sign, which is + at 0",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = wr_hard_hc153,
      .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\nsurface sphere R=0.7\n"
               "bump height=0.03\nobject set size=1,0.6,0" },
    { .id = "HC154",
      .subject = WR_HARD_RENDER,
      .what = "two objects 1 apart, ten million from the middle",
      .holds = "they stand and are picked as they are in the middle",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = wr_hard_hc154,
      .scene = "table 16x16\nsurface sphere R=0.4\nobject set at=9999999.5,1e7,0\n"
               "object add box at=10000000.5,1e7,0 size=0.5\nsurface cube\n"
               "camera perspective eye=10000001,10000001,4 target=1e7,1e7,0" },
};
WR_HARD_LIST(stretch, rows);
