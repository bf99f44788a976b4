#include "scene/objects.h"

#include "base/error.h"
#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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

int wr_scene_shown_count(const WrScene *scene)
{
    int shown = 0;
    for (int i = 0; i < wr_scene_object_count(scene); i++)
        shown += !wr_scene_object(scene, i)->hidden;
    return shown;
}

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

/* `object` as the active one at index `chosen`, the rest from list [count], which is consumed. */
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
           (object->form_layer && strcmp(object->form_layer, layer) == 0);
}

bool wr_scene_wears(const WrScene *scene, const char *layer)
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

WrScene *wr_scene_remove_object(const WrScene *scene, int i)
{
    const int at_hand = scene->chosen == i ? (i > 0 ? i - 1 : i + 1) : scene->chosen;
    WrScene **list = wr_alloc((size_t)scene->other_count, sizeof(WrScene *));
    int count = 0;
    for (int k = 0; k <= scene->other_count; k++)
        if (k != i && k != at_hand) list[count++] = alone(scene, k);
    return join(scene, wr_scene_object(scene, at_hand), list, count, at_hand - (at_hand > i));
}

/* Cached radius of an object in a scene, which is immutable. */
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

bool wr_scene_fits(const WrScene *scene, int i)
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

double wr_scene_stands_out(const WrScene *object)
{
    const bool formula = object->analytic.kind != WR_ANALYTIC_OFF;
    if (!object->displaced || wr_shape_unmoved(&object->shape)) return 0;
    return fabs(object->height) * (formula ? wr_analytic_amplitude(&object->analytic) : 1);
}

double wr_scene_ball(const WrScene *scene, bool displaced)
{
    double ball = 0;
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const WrScene *object = wr_scene_object(scene, i);
        if (!wr_scene_fits(scene, i)) continue;
        const double more = displaced ? wr_scene_stands_out(object) : 0;
        ball = fmax(ball, v3_len(object->at) + object->size * (radius_of(scene, i) + more));
    }
    return ball;
}

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

bool wr_scene_shows(const WrScene *scene, int i, double aspect)
{
    WrPlacement place;
    const WrScene *object = wr_scene_object(scene, i);
    if (object->hidden) return false;
    if (!object->still || object->shape.kind != WR_SURFACE_plane || scene->other_count == 0)
        return true;
    WrScene *part = wr_scene_part(scene, i, aspect);
    const bool placed = wr_scene_place(part, 0, aspect, &place, NULL);
    wr_scene_free(part);
    if (!placed) return true;
    const double *m = place.rotation;
    const WrVec3 front = { m[2], m[5], m[8] }; /* a plane faces along its own z */
    return place.orthographic ? v3_dot(front, place.forward) <= 0
                              : v3_dot(front, v3_sub(place.eye, place.position)) >= 0;
}

WrScene *wr_scene_part(const WrScene *scene, int i, double aspect)
{
    WrScene *part = under(scene, wr_scene_object(scene, i));
    wr_scene_hold_camera(part, scene, aspect);
    return part;
}
