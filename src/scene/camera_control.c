#include "scene/camera_control.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/enum_rows.h"
#include "base/vec.h"
#include "scene/objects.h"
#include "surface/triangles.h"

#include <math.h>

#define MARGIN 1.02  /* of wr_camera_control_fill */
#define GRID 96      /* cells along u and v of a face's sample grid */
#define GRID_MANY 24 /* the same for surfaces of many faces */
#define TURNS 72     /* steps of a whole turn of the turntable */
#define STEEPEST 89.98

WR_ROWS(wr_side_names);
const char *const wr_side_names[WR_SIDE_COUNT] = {
    [WR_ROW(WR_SIDE_FRONT)] = "front", [WR_ROW(WR_SIDE_BACK)] = "back",
    [WR_ROW(WR_SIDE_LEFT)] = "left",   [WR_ROW(WR_SIDE_RIGHT)] = "right",
    [WR_ROW(WR_SIDE_TOP)] = "top",     [WR_ROW(WR_SIDE_BOTTOM)] = "bottom",
};
WR_ROWS_END(wr_side_names, WR_SIDE_COUNT);

/* ---- orbiting ---- */

static double right_angle(double deg)
{
    return 90 * rint(deg / 90) + 0.0;
}

void wr_camera_control_side(WrScene *scene, WrSide side)
{
    WR_ROWS(sides);
    static const struct {
        WrVec3 from, up;
    } sides[WR_SIDE_COUNT] = {
        [WR_ROW(WR_SIDE_FRONT)] = { { 0, 0, 1 }, { 0, 1, 0 } },
        [WR_ROW(WR_SIDE_BACK)] = { { 0, 0, -1 }, { 0, 1, 0 } },
        [WR_ROW(WR_SIDE_LEFT)] = { { -1, 0, 0 }, { 0, 1, 0 } },
        [WR_ROW(WR_SIDE_RIGHT)] = { { 1, 0, 0 }, { 0, 1, 0 } },
        [WR_ROW(WR_SIDE_TOP)] = { { 0, 1, 0 }, { 0, 0, -1 } },
        [WR_ROW(WR_SIDE_BOTTOM)] = { { 0, -1, 0 }, { 0, 0, 1 } },
    };
    WR_ROWS_END(sides, WR_SIDE_COUNT);
    WrCamera *camera = &scene->camera;
    const double away = v3_len(v3_sub(camera->eye, camera->target));
    camera->eye = v3_mad(camera->target, sides[side].from, away);
    camera->up = sides[side].up;
    if (scene->other_count > 0) return;
    const double *pose = wr_surfaces[scene->shape.kind]->pose_deg;
    scene->posed = true;
    scene->rotate_deg =
        (WrVec3){ right_angle(pose[0]), right_angle(pose[1]), right_angle(pose[2]) };
}

/* Longitude and latitude of the eye about the target. STEEPEST keeps the view off the poles, where the
   longitude is undefined. */
void wr_camera_control_orbit(WrScene *scene, double right_deg, double up_deg)
{
    WrCamera *camera = &scene->camera;
    const WrVec3 back = v3_sub(camera->eye, camera->target);
    const double away = v3_len(back), flat_away = sqrt(back.x * back.x + back.z * back.z);
    /* Seen from above or below, the picture's up direction determines the camera's heading. */
    const bool pole = flat_away < 1e-6 * away;
    const WrVec3 level = pole ? v3_scale(camera->up, back.y > 0 ? -1 : 1) : back;
    const double round = wr_atan2(level.x, level.z) / WR_RAD_PER_DEG + right_deg;
    const double now = wr_atan2(back.y, flat_away) / WR_RAD_PER_DEG;
    const double up = fmin(STEEPEST, fmax(-STEEPEST, now + up_deg));
    double s, c, rise, flat;
    wr_sincos_turns(remainder(round, 360) / 360, &s, &c);
    wr_sincos_turns(up / 360, &rise, &flat);
    camera->eye = v3_mad(camera->target, (WrVec3){ flat * s, rise, flat * c }, away);
    camera->up = (WrVec3){ 0, 1, 0 };
}

/* ---- panning and dollying ---- */

/* The camera at its present position, no longer fitting. */
static bool hold(WrScene *scene, double aspect, WrPlacement *place, WrError *err)
{
    if (!wr_scene_place(scene, 0, aspect, place, err)) return false;
    if (scene->camera.fit) scene->camera.frame = 0; /* of the previous view */
    scene->camera.fit = false;
    scene->camera.eye = place->eye;
    if (place->orthographic) scene->camera.size = 2 * place->half_height / place->widen;
    return true;
}

bool wr_camera_control_pan(WrScene *scene, double right, double up, double aspect, WrError *err)
{
    WrPlacement place;
    WrCamera *camera = &scene->camera;
    if (!hold(scene, aspect, &place, err)) return false;
    const double away = v3_len(v3_sub(camera->eye, camera->target));
    const double height = 2 * place.half_height * (place.orthographic ? 1 : away);
    const WrVec3 by = v3_mad(v3_scale(place.right, right * height), place.up, up * height);
    camera->eye = v3_add(camera->eye, by);
    /* At the target's distance the picture is 2 half_height away high: the point under the pointer follows it
       exactly. */
    camera->target = v3_add(camera->target, by);
    return true;
}

bool wr_camera_control_dolly(WrScene *scene, double factor, double aspect, WrError *err)
{
    WrPlacement place;
    WrCamera *camera = &scene->camera;
    if (!hold(scene, aspect, &place, err)) return false;
    if (place.orthographic) camera->size *= factor;
    else camera->eye = v3_mad(camera->target, v3_sub(camera->eye, camera->target), factor);
    return true;
}

/* ---- filling the picture ---- */

/* One pass over the objects' points determines the closest eye from which all are visible; no iteration. */

#define SLOPES 32

/* Extents of points along the camera's axes. A pyramid whose sides have slope k and whose tip is at e
   contains a point if x - ex <= k (z - ez), and so on for -x, y, -y. Each is a bound of e by the
   maximum of x - k z over all points; the deepest tip follows from the four. Several slopes are stored,
   since in the direction in which the picture has room left, the object is centred in the smallest
   pyramid that contains it. Orthographic: slopes of 0. */
typedef struct Reach {
    WrVec3 right, up, forward;
    double slope[2][SLOPES];                  /* along x and y; the last is the picture's */
    double least[2][SLOPES], most[2][SLOPES]; /* maximum of -x - k z and of x - k z */
    double near, far;                         /* of z */
} Reach;

static Reach reach_start(WrVec3 right, WrVec3 up, WrVec3 forward, double slope_x, double slope_y)
{
    Reach r = { .right = right, .up = up, .forward = forward, .near = INFINITY, .far = -INFINITY };
    for (int k = 0; k < SLOPES; k++) {
        r.slope[0][k] = slope_x * (k + 1) / SLOPES;
        r.slope[1][k] = slope_y * (k + 1) / SLOPES;
        for (int axis = 0; axis < 2; axis++) r.least[axis][k] = r.most[axis][k] = -INFINITY;
    }
    return r;
}

/* least and most are maxima, so points can come in any order; for each point SLOPES multiplications per axis. */
static void reach_point(Reach *r, WrVec3 p)
{
    const double z = v3_dot(r->forward, p), at[2] = { v3_dot(r->right, p), v3_dot(r->up, p) };
    for (int axis = 0; axis < 2; axis++)
        for (int k = 0; k < SLOPES; k++) {
            const double a = at[axis], by = r->slope[axis][k] * z;
            r->least[axis][k] = r->least[axis][k] > -a - by ? r->least[axis][k] : -a - by;
            r->most[axis][k] = r->most[axis][k] > a - by ? r->most[axis][k] : a - by;
        }
    r->near = fmin(r->near, z), r->far = fmax(r->far, z);
}

/* Maximum depth of a tip of that slope.
   A tip at e contains all points if most <= ex - k ez and least <= -ex - k ez; the sum of both bounds ez. */
static double tip(const Reach *r, int axis, int k)
{
    return -(r->least[axis][k] + r->most[axis][k]) / (2 * r->slope[axis][k]);
}

/* Lateral position of a tip at depth `eye`: interpolated between two slopes.
   If the picture is limited by the other axis, the eye is farther away than this axis needs; then the
   narrowest pyramid with its tip at that depth centres the object. */
static double across(const Reach *r, int axis, double eye)
{
    int k = SLOPES - 1;
    while (k > 0 && tip(r, axis, k - 1) >= eye) k--;
    const double own = (r->most[axis][k] - r->least[axis][k]) / 2, here = tip(r, axis, k);
    if (k == 0 || here <= eye) return own;
    const double before = tip(r, axis, k - 1), share = (eye - before) / (here - before);
    const double other = (r->most[axis][k - 1] - r->least[axis][k - 1]) / 2;
    return other + (own - other) * share;
}

/* All placements of one object during the turn. */
typedef struct Turns {
    WrPlacement place[TURNS + 1];
    int count;
} Turns;

static void reach_turns(Reach *r, const Turns *turns, WrVec3 p)
{
    for (int k = 0; k < turns->count; k++) reach_point(r, wr_object_to_world(&turns->place[k], p));
}

static void reach_object(Reach *r, const WrScene *object, const Turns *turns)
{
    const WrSurfaceInfo *info = wr_surfaces[object->shape.kind];
    if (info->held && object->triangles) {
        const WrTriangles *mesh = object->triangles;
        for (int32_t i = 0; i < mesh->corner_count; i++) {
            const float *p = mesh->corners[i].p;
            reach_turns(r, turns, (WrVec3){ p[0], p[1], p[2] });
        }
        return;
    }
    const int cells = info->faces > 6 ? GRID_MANY : GRID;
    for (int face = 0; face < info->faces; face++)
        for (int j = 0; j <= cells; j++)
            for (int i = 0; i <= cells; i++) {
                WrSurfacePoint at;
                const WrSurfaceCell c = wr_surface_cell(&object->shape, face);
                wr_surface_at(&object->shape, face, c.u0 + (c.u1 - c.u0) * i / cells,
                              c.v0 + (c.v1 - c.v0) * j / cells, &at);
                reach_turns(r, turns, at.p);
            }
}

/* At most TURNS steps of 5 degrees for a whole turn; between two steps a point leaves the chord by 0.1 % of
   its distance from the axis, which MARGIN covers. */
static bool place_turns(const WrScene *part, double from, double to, Turns *out, WrError *err)
{
    const double radius = wr_shape_radius(&part->shape);
    const int steps = (int)fmin(TURNS, ceil(fabs(to - from) * (TURNS / 360.0)));
    out->count = steps + 1;
    for (int k = 0; k <= steps; k++) {
        const double turn = from + (steps ? (to - from) * k / steps : 0);
        if (!wr_scene_place_with_radius(part, radius, turn, 1, &out->place[k], err)) return false;
    }
    return true;
}

static bool reach_all(Reach *r, const WrScene *scene, double turn_from, double turn_to,
                      WrError *err)
{
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        if (!wr_scene_fit_includes(scene, i)) continue;
        Turns turns;
        WrScene *part = wr_scene_object_alone(scene, i, 1);
        const bool good = place_turns(part, turn_from, turn_to, &turns, err);
        if (good) reach_object(r, part, &turns);
        wr_scene_free(part);
        if (!good) return false;
    }
    return true;
}

/* near - least: the eye stays outside the objects even where the pyramid would allow it inside. */
bool wr_camera_control_fill(WrScene *scene, double aspect, double turn_from, double turn_to,
                            WrError *err)
{
    WrPlacement place;
    WrCamera *camera = &scene->camera;
    camera->frame = aspect;
    if (!wr_scene_place(scene, 0, aspect, &place, err)) return false;
    const bool flat = place.orthographic;
    const double slope = flat ? 0 : place.half_height / MARGIN;
    Reach r = reach_start(place.right, place.up, place.forward, slope * aspect, slope);
    if (!reach_all(&r, scene, turn_from, turn_to, err)) return false;
    const double least = 1e-6 * place.ball;
    const int whole = SLOPES - 1;
    double eye = r.near - place.ball, x = (r.most[0][0] - r.least[0][0]) / 2,
           y = (r.most[1][0] - r.least[1][0]) / 2;
    if (flat) {
        const double wide = r.least[0][0] + r.most[0][0], high = r.least[1][0] + r.most[1][0];
        camera->size = MARGIN * fmax(fmax(high, wide / aspect), least);
    } else {
        eye = fmin(fmin(tip(&r, 0, whole), tip(&r, 1, whole)), r.near - least);
        x = across(&r, 0, eye), y = across(&r, 1, eye);
    }
    const WrVec3 axis = v3_add(v3_scale(place.right, x), v3_scale(place.up, y));
    camera->fit = false;
    camera->eye = v3_mad(axis, place.forward, eye);
    camera->target = v3_mad(axis, place.forward, (r.near + r.far) / 2);
    return true;
}

bool wr_camera_control_lowest(const WrScene *scene, double *y, WrError *err)
{
    Reach r = reach_start((WrVec3){ 1, 0, 0 }, (WrVec3){ 0, 1, 0 }, (WrVec3){ 0, 0, -1 }, 0, 0);
    if (!reach_all(&r, scene, 0, 0, err)) return false;
    *y = -r.least[1][0];
    return true;
}
