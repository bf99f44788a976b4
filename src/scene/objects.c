#include "scene/objects.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/vec.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Maximum displacement of a displaced surface from its base, in the object's units, for table heights
   of -1..1 or the bound of its formula; 0: not displaced. The table's heights are not used: a camera
   must not move while the user paints.
   A scene is one active object, which is the WrScene itself, and `others`: complete scenes of one object each,
   shared and immutable, in the order of all objects without the active one. Object i is others[i] before
   `chosen` and others[i - 1] after it. Settings of the whole scene (lights, camera, dials) count only in the
   active one; under() copies them where needed. */
static double scene_stands_out(const WrScene *object);

/* ---- place ---- */

/* Ratio of the view to the object's bounding sphere, so that the object does not touch the picture's
   border. */
#define MARGIN 1.04

static bool finite3(WrVec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

/* out = a b, 3 x 3, row-major */
static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
    }
}

/* out = (rotation by `deg` about the axis 0, 1, 2 = x, y, z) in. Whole turns are subtracted exactly
 * before rounding, so that the angle of a turntable after days is as accurate as a small one (HC87). */
static void turn(int axis, double deg, const double in[9], double out[9])
{
    double s, c;
    wr_sincos_turns(remainder(deg, 360) / 360, &s, &c);
    int j = (axis + 1) % 3, k = (axis + 2) % 3;
    double m[9] = { 0 };
    m[4 * axis] = 1;
    m[4 * j] = m[4 * k] = c;
    m[3 * j + k] = -s;
    m[3 * k + j] = s;
    multiply(m, in, out);
}

static WrVec3 turned(const double m[9], WrVec3 p)
{
    return (WrVec3){ m[0] * p.x + m[1] * p.y + m[2] * p.z, m[3] * p.x + m[4] * p.y + m[5] * p.z,
                     m[6] * p.x + m[7] * p.y + m[8] * p.z };
}

/* A size relative to the largest, at least the thinnest; 0 becomes positive.
   WR_THINNEST instead of 0: cofactors divide by it, and rays to object space too (HC153). */
static double part_of(double size, double largest)
{
    const double part = size / largest;
    return part < 0 ? fmin(part, -WR_THINNEST) : fmax(part, WR_THINNEST);
}

/* Cofactors of the stretch times the sign of its determinant: |s1 s2 s3| / s.
   The normal of a stretched surface is n / s per component, up to a factor; the product of all sizes keeps it
   finite. The sign of the determinant keeps it outward for mirrored objects (HC34). */
static void place_stretch(WrVec3 sizes, WrPlacement *out)
{
    const double largest = fmax(fabs(sizes.x), fmax(fabs(sizes.y), fabs(sizes.z)));
    out->stretched = largest > 0;
    out->stretch = out->cofactor = (WrVec3){ 1, 1, 1 };
    if (!out->stretched) return;
    const WrVec3 s = { part_of(sizes.x, largest), part_of(sizes.y, largest),
                       part_of(sizes.z, largest) };
    const double all = fabs(s.x * s.y * s.z);
    out->stretch = s;
    out->cofactor = (WrVec3){ all / s.x, all / s.y, all / s.z };
}

void wr_scene_stretch(const WrScene *scene, WrVec3 *stretch, WrVec3 *cofactor)
{
    WrPlacement place;
    place_stretch(scene->sizes, &place);
    *stretch = place.stretch;
    *cofactor = place.cofactor;
}

bool wr_scene_is_thin(const WrScene *scene)
{
    WrPlacement place;
    place_stretch(scene->sizes, &place);
    const WrVec3 s = place.stretch;
    return place.stretched && fmin(fabs(s.x), fmin(fabs(s.y), fabs(s.z))) < 1.0 / 32;
}

/* Turntable Ry(turn) after the pose Rz Ry Rx; it also rotates the object's position.
   Columns of `rotation` are the object's axes in the world. Poses rotate about the world's x, then y, then z
   axis, the turntable about y last, in one product, rebuilt for each frame: no drift (HC88). */
static void place_object(const WrScene *scene, double turn_deg, WrPlacement *out)
{
    const double *pose = wr_surfaces[scene->shape.kind]->pose_deg;
    WrVec3 deg = scene->posed ? scene->rotate_deg : (WrVec3){ pose[0], pose[1], pose[2] };
    const double same[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    double a[9], b[9];
    if (scene->still) turn_deg = 0;
    turn(0, deg.x, same, a);
    turn(1, deg.y, a, b);
    turn(2, deg.z, b, a);
    turn(1, turn_deg, a, out->rotation);
    turn(1, turn_deg, same, a);
    out->position = turned(a, scene->at);
    out->size = scene->size;
    place_stretch(scene->sizes, out);
}

/* Replacement if `up` is 0 or parallel to the view: the far side is up when looking straight down, the
 * near side when looking straight up, else the world's y. */
static WrVec3 other_up(WrVec3 forward)
{
    if (fabs(forward.y) > 0.9) return (WrVec3){ 0, 0, forward.y > 0 ? 1 : -1 };
    return (WrVec3){ 0, 1, 0 };
}

/* right = forward x up. If that product is short its direction consists of rounding errors: it is made
   perpendicular to `forward` again. */
static void place_axes(const WrCamera *camera, WrVec3 forward, WrPlacement *out)
{
    const WrVec3 none = { 0, 0, 0 };
    WrVec3 across = v3_cross(forward, v3_unit(camera->up, none));
    if (v3_len(across) < 1e-9) across = v3_cross(forward, other_up(forward));
    out->forward = forward;
    out->right = v3_unit(across, none);
    if (v3_len(across) < 1e-3) { /* a short product consists of rounding errors */
        across = v3_mad(out->right, forward, -v3_dot(out->right, forward));
        out->right = v3_unit(across, none);
    }
    out->up = v3_unit(v3_cross(out->right, forward), none);
}

static bool check_camera(const WrCamera *camera, double aspect, WrError *err)
{
    if (!(aspect > 0) || !isfinite(aspect))
        return wr_fail(err, "aspect ratio %g: must be above 0", aspect);
    if (!finite3(camera->eye) || !finite3(camera->target) || !finite3(camera->up))
        return wr_fail(err, "camera eye, target, up: must be finite");
    if (!camera->orthographic && !(camera->fov_deg >= 0.01 && camera->fov_deg <= 179))
        return wr_fail(err, "camera fov = %g: must be 0.01..179 degrees", camera->fov_deg);
    if (!isfinite(camera->size)) return wr_fail(err, "camera size: must be finite");
    if (!(camera->frame >= 0 && camera->frame <= 1e4))
        return wr_fail(err, "camera frame = %g: must be 0..10000", camera->frame);
    WrVec3 back = v3_sub(camera->eye, camera->target);
    if (!finite3(back) || v3_len(back) > 1e150)
        return wr_fail(err, "camera eye and target: too far apart; keep them within 1e150");
    if (v3_len(back) > 0) return true;
    return wr_fail(err, "camera eye = target = %g,%g,%g: no direction of view; move the eye",
                   camera->eye.x, camera->eye.y, camera->eye.z);
}

/* Distance of the eye from the target so that a sphere of radius `ball` about the target fits: its
 * outline, at ball / sqrt(distance^2 - ball^2), is at the nearer border divided by `margin`. Parallel
 * rays: twice the radius; for a larger sphere that fills the picture (margin 1) twice that of the
 * sphere that would keep MARGIN. */
static double fit_distance(double ball, double margin, double half_height, double aspect,
                           bool orthographic)
{
    if (orthographic) return margin < MARGIN ? 2 * ball / MARGIN : 2 * ball;
    double half = half_height * (aspect < 1 ? aspect : 1); /* for the nearer pair of borders */
    return ball * sqrt(1 + margin / half * (margin / half));
}

/* widen shows at least the width of `frame` in narrower pictures: half_height grows by frame / aspect. */
static void place_camera(const WrCamera *camera, double aspect, WrPlacement *out)
{
    WrVec3 back = v3_unit(v3_sub(camera->eye, camera->target), (WrVec3){ 0, 0, 1 });
    place_axes(camera, v3_neg(back), out);
    /* The objects' sphere is about the world's origin; this one is about the target and contains it. */
    const double off = v3_len(camera->target);
    double ball = out->ball + off, reach = out->reach + off;
    out->orthographic = camera->orthographic;
    if (camera->orthographic) {
        double fitted = fmax(MARGIN * ball, reach) * (aspect < 1 ? 1 / aspect : 1);
        out->half_height = camera->size > 0 ? camera->size / 2 : fitted;
    } else {
        double s, c;
        wr_sincos_turns(camera->fov_deg / 720, &s, &c);
        out->half_height = s / c;
    }
    const bool fits = camera->fit || (camera->orthographic && camera->size <= 0);
    out->widen = !fits && camera->frame > aspect ? camera->frame / aspect : 1;
    out->half_height *= out->widen;
    /* The bases keep the margin; only displacements beyond it move the eye. */
    const double away =
        fmax(fit_distance(ball, MARGIN, out->half_height, aspect, camera->orthographic),
             fit_distance(reach, 1, out->half_height, aspect, camera->orthographic));
    out->eye = camera->fit ? v3_mad(camera->target, back, away) : camera->eye;
}

bool wr_scene_place(const WrScene *scene, double turn_deg, double aspect, WrPlacement *out,
                    WrError *err)
{
    return wr_scene_place_with_radius(scene, wr_shape_radius(&scene->shape), turn_deg, aspect, out,
                                      err);
}

/* The scene is placed even if the object's mesh is large: `radius` is the caller's, who may have cached it. */
bool wr_scene_place_with_radius(const WrScene *scene, double radius, double turn_deg, double aspect,
                                WrPlacement *out, WrError *err)
{
    if (!check_camera(&scene->camera, aspect, err)) return false;
    if (!isfinite(turn_deg)) return wr_fail(err, "turn: the angle must be finite");
    if (scene->posed && !finite3(scene->rotate_deg))
        return wr_fail(err, "rotate: the angles must be finite");
    WrPlacement placed;
    memset(&placed, 0, sizeof placed);
    placed.centre = wr_shape_centre(&scene->shape);
    placed.radius = radius;
    place_object(scene, turn_deg, &placed);
    const bool one = scene->other_count == 0;
    placed.ball =
        one ? v3_len(scene->at) + scene->size * radius : wr_scene_bounding_radius(scene, false);
    placed.reach = one ? placed.ball + scene->size * scene_stands_out(scene)
                       : wr_scene_bounding_radius(scene, true);
    place_camera(&scene->camera, aspect, &placed);
    *out = placed;
    return true;
}

WrVec3 wr_object_to_world(const WrPlacement *place, WrVec3 p)
{
    WrVec3 away = v3_sub(p, place->centre);
    if (place->stretched) away = v3_times(away, place->stretch);
    const WrVec3 own = turned(place->rotation, away);
    return v3_mad(place->position, own, place->size);
}

WrVec3 wr_place_turn_back(const WrPlacement *place, WrVec3 w)
{
    const double *m = place->rotation;
    return (WrVec3){ m[0] * w.x + m[3] * w.y + m[6] * w.z, m[1] * w.x + m[4] * w.y + m[7] * w.z,
                     m[2] * w.x + m[5] * w.y + m[8] * w.z };
}

/* The inverse of the stretch after the inverse rotation; for directions and differences of points. */
WrVec3 wr_place_shrink_back(const WrPlacement *place, WrVec3 w)
{
    const WrVec3 own = wr_place_turn_back(place, w), s = place->stretch;
    if (!place->stretched) return own;
    return (WrVec3){ own.x / s.x, own.y / s.y, own.z / s.z };
}

/* Gradients and other duals transform by the transposed map: w.p stays equal if p is transformed by the
   inverse. */
WrVec3 wr_place_dual_back(const WrPlacement *place, WrVec3 w)
{
    const WrVec3 own = wr_place_turn_back(place, w);
    return place->stretched ? v3_times(own, place->stretch) : own;
}

WrVec3 wr_world_to_object(const WrPlacement *place, WrVec3 world)
{
    const WrVec3 own = wr_place_shrink_back(place, v3_sub(world, place->position));
    return v3_add(v3_scale(own, 1 / place->size), place->centre);
}

int wr_scene_object_count(const WrScene *scene)
{
    return scene->other_count + 1;
}

const WrScene *wr_scene_object(const WrScene *scene, int i)
{
    WR_ASSERT(i >= 0 && i <= scene->other_count);
    if (i == scene->chosen) return scene;
    return scene->others[i < scene->chosen ? i : i - 1];
}

const char *wr_scene_object_label(const WrScene *scene, int i, char buffer[WR_OBJECT_LABEL])
{
    const char *name = wr_scene_object(scene, i)->name;
    if (name) return name;
    snprintf(buffer, WR_OBJECT_LABEL, "object %d", i + 1);
    return buffer;
}

int wr_scene_object_find(const WrScene *scene, const char *name)
{
    char buffer[WR_OBJECT_LABEL];
    for (int i = 0; i < wr_scene_object_count(scene); i++)
        if (strcmp(wr_scene_object_label(scene, i, buffer), name) == 0) return i;
    return -1;
}

/* `others` are owned references; scenes are freed when the last reference goes. */
static void drop_others(WrScene *scene)
{
    for (int i = 0; i < scene->other_count; i++) wr_scene_free(scene->others[i]);
    wr_free(scene->others);
    scene->others = NULL;
    scene->other_count = 0;
    scene->chosen = 0;
}

/* The object alone, for `others`. */
static WrScene *alone(const WrScene *scene, int i)
{
    if (i != scene->chosen) return wr_scene_share(wr_scene_object(scene, i));
    WrScene *object = wr_scene_clone(scene);
    drop_others(object);
    return object;
}

/* The scene's lights, camera, dials and other shared settings, with an object's own properties. */
static WrScene *under(const WrScene *scene, const WrScene *object)
{
    WrScene *made = wr_scene_clone(object);
    drop_others(made);
    wr_scene_take_shared(made, scene);
    return made;
}

/* `object` as the active one at index `chosen`, the rest from list [count], which is consumed.
   The list becomes the new scene's property. The index of the active object stays its place in the order of
   all. */
static WrScene *join(const WrScene *scene, const WrScene *object, WrScene **list, int count,
                     int chosen)
{
    WrScene *made = under(scene, object);
    made->others = list;
    made->other_count = count;
    made->chosen = chosen;
    return made;
}

/* All objects except `without` (-1: all), each a share. */
static WrScene **list_of(const WrScene *scene, int without, int *count)
{
    const int all = wr_scene_object_count(scene);
    WrScene **list = wr_alloc((size_t)all, sizeof(WrScene *));
    *count = 0;
    for (int i = 0; i < all; i++)
        if (i != without) list[(*count)++] = alone(scene, i);
    return list;
}

WrScene *wr_scene_choose(const WrScene *scene, int i)
{
    int count;
    if (i == scene->chosen) return wr_scene_clone(scene);
    WrScene **list = list_of(scene, i, &count);
    return join(scene, wr_scene_object(scene, i), list, count, i);
}

WrScene *wr_scene_add_object(const WrScene *scene, bool copy)
{
    int count;
    WrScene **list = list_of(scene, -1, &count);
    WrScene *empty = copy ? NULL : wr_scene_new();
    WrScene *made = join(scene, copy ? scene : empty, list, count, count);
    wr_scene_free(empty);
    wr_free(made->name);
    made->name = NULL;
    return made;
}

void wr_scene_set_object(WrScene *scene, int i, WrScene *object)
{
    WrScene **place = &scene->others[i < scene->chosen ? i : i - 1];
    wr_scene_free(*place);
    *place = object;
}

WrScene *wr_scene_hide(const WrScene *scene, int i, bool hidden)
{
    WrScene *made = wr_scene_clone(scene);
    if (i == scene->chosen) {
        made->hidden = hidden;
        return made;
    }
    WrScene *other = wr_scene_clone(wr_scene_object(scene, i));
    other->hidden = hidden;
    wr_scene_set_object(made, i, other);
    return made;
}

static bool wears(const WrScene *object, const char *layer)
{
    return (object->layer && strcmp(object->layer, layer) == 0) ||
           (object->form_layer && strcmp(object->form_layer, layer) == 0) ||
           (object->mask_layer && strcmp(object->mask_layer, layer) == 0);
}

bool wr_scene_uses_layer(const WrScene *scene, const char *layer)
{
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const WrScene *object = wr_scene_object(scene, i);
        if (!object->hidden && wears(object, layer)) return true;
    }
    return false;
}

static void rename_one(char **name, const char *from, const char *to)
{
    if (!*name || strcmp(*name, from) != 0) return;
    wr_free(*name);
    *name = wr_strdup(to);
}

static void wear(WrScene *object, const char *from, const char *to)
{
    rename_one(&object->layer, from, to);
    rename_one(&object->form_layer, from, to);
    rename_one(&object->mask_layer, from, to);
}

WrScene *wr_scene_rename_layer(const WrScene *scene, const char *from, const char *to)
{
    bool any = wears(scene, from);
    for (int i = 0; i < scene->other_count; i++) any |= wears(scene->others[i], from);
    if (!any) return NULL;
    WrScene *made = wr_scene_clone(scene);
    wear(made, from, to);
    for (int i = 0; i < made->other_count; i++) {
        if (!wears(made->others[i], from)) continue;
        WrScene *other = wr_scene_clone(made->others[i]);
        wear(other, from, to);
        wr_scene_free(made->others[i]);
        made->others[i] = other;
    }
    return made;
}

/* Each other object is cloned before the change: it may be shared with snapshots of the undo history. */
void wr_scene_set_all_slopes(WrScene *scene, bool scheme, bool normals)
{
    for (int i = 0; i < scene->other_count; i++) {
        WrScene *other = wr_scene_clone(scene->others[i]);
        if (scheme) other->scheme = scene->scheme;
        if (normals && other->bump != WR_BUMP_INVARIANT && scene->bump != WR_BUMP_INVARIANT)
            other->bump = scene->bump;
        wr_scene_free(scene->others[i]);
        scene->others[i] = other;
    }
}

/* Removing the active object activates its predecessor; indices after the removed one shift by one. */
WrScene *wr_scene_remove_object(const WrScene *scene, int i)
{
    const int at_hand = scene->chosen == i ? (i > 0 ? i - 1 : i + 1) : scene->chosen;
    WrScene **list = wr_alloc((size_t)scene->other_count, sizeof(WrScene *));
    int count = 0;
    for (int k = 0; k <= scene->other_count; k++)
        if (k != i && k != at_hand) list[count++] = alone(scene, k);
    return join(scene, wr_scene_object(scene, at_hand), list, count, at_hand - (at_hand > i));
}

/* Cached radius of an object in a scene, which is immutable.
   Radius 0 means not computed. Two threads may compute it at once; both store the same bits, and relaxed order
   suffices because nothing else depends on the store. */
static double kept_radius(WrScene *object)
{
    double radius;
    __atomic_load(&object->radius, &radius, __ATOMIC_RELAXED);
    if (radius > 0) return radius;
    radius = wr_shape_radius(&object->shape);
    __atomic_store(&object->radius, &radius, __ATOMIC_RELAXED); /* every thread computes the same */
    return radius;
}

static double radius_of(const WrScene *scene, int i)
{
    if (i == scene->chosen) return wr_shape_radius(&scene->shape);
    return kept_radius(scene->others[i < scene->chosen ? i : i - 1]);
}

/* Objects that the turntable leaves in place (a ground plane) would make a fitted camera step back; they count
   only if nothing else is shown. */
bool wr_scene_fit_includes(const WrScene *scene, int i)
{
    int shown = 0, turned = 0;
    for (int k = 0; k < wr_scene_object_count(scene); k++) {
        const WrScene *object = wr_scene_object(scene, k);
        shown += !object->hidden;
        turned += !object->hidden && !object->still;
    }
    const WrScene *object = wr_scene_object(scene, i);
    if (turned > 0) return !object->hidden && !object->still;
    return shown == 0 || !object->hidden;
}

static double scene_stands_out(const WrScene *object)
{
    const bool formula = object->analytic.kind != WR_ANALYTIC_OFF;
    if (!object->displaced || wr_shape_unmoved(&object->shape)) return 0;
    return fabs(object->height) * (formula ? wr_analytic_amplitude(&object->analytic) : 1);
}

/* The radius of a sphere about the world's origin; it does not change with the turntable, so the camera stands
   still. */
double wr_scene_bounding_radius(const WrScene *scene, bool displaced)
{
    double ball = 0;
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const WrScene *object = wr_scene_object(scene, i);
        if (!wr_scene_fit_includes(scene, i)) continue;
        const double more = displaced ? scene_stands_out(object) : 0;
        ball = fmax(ball, v3_len(object->at) + object->size * (radius_of(scene, i) + more));
    }
    return ball;
}

/* Replaces `fit` by the numbers that it resolves to, so that a part of the scene is seen by the same camera. */
void wr_scene_hold_camera(WrScene *scene, const WrScene *like, double aspect)
{
    WrPlacement place;
    WrCamera *camera = &scene->camera;
    if (!camera->fit && !camera->orthographic) return;
    if (!wr_scene_place(like, 0, aspect, &place, NULL)) return;
    camera->fit = false;
    camera->eye = place.eye;
    if (camera->orthographic) camera->size = 2 * place.half_height / place.widen;
}

/* A still ground plane seen from below would cover everything: it is then left out. */
bool wr_scene_shows(const WrScene *scene, int i, double aspect)
{
    WrPlacement place;
    const WrScene *object = wr_scene_object(scene, i);
    if (object->hidden) return false;
    if (!object->still || object->shape.kind != WR_SURFACE_plane || scene->other_count == 0)
        return true;
    WrScene *part = wr_scene_object_alone(scene, i, aspect);
    const bool placed = wr_scene_place(part, 0, aspect, &place, NULL);
    wr_scene_free(part);
    if (!placed) return true;
    const double *m = place.rotation;
    const WrVec3 front = { m[2], m[5], m[8] }; /* a plane faces along its own z */
    return place.orthographic ? v3_dot(front, place.forward) <= 0
                              : v3_dot(front, v3_sub(place.eye, place.position)) >= 0;
}

WrScene *wr_scene_object_alone(const WrScene *scene, int i, double aspect)
{
    WrScene *part = under(scene, wr_scene_object(scene, i));
    wr_scene_hold_camera(part, scene, aspect);
    return part;
}
