/* Comparison of scenes that differ only in light. */
#include "scene/scene.h"

#include <string.h>

/* Compares the repetition; the caller compares the picture itself. */
static bool same_laid(const WrTextureSample *a, const WrTextureSample *b)
{
    return a->own == b->own && a->ru == b->ru && a->rv == b->rv;
}

static bool same_map(const WrNormalMap *a, const WrNormalMap *b)
{
    return a->image == b->image && same_laid(&a->laid, &b->laid) && a->channels == b->channels &&
           a->green_down == b->green_down && a->object == b->object && a->frame == b->frame &&
           a->strength == b->strength;
}

static bool same_formula(const WrAnalytic *a, const WrAnalytic *b)
{
    return a->kind == b->kind && a->count == b->count &&
           (a->count == 0 || memcmp(a->terms, b->terms, (size_t)a->count * sizeof *a->terms) == 0);
}

static bool same_vec(WrVec3 a, WrVec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool same_camera(const WrCamera *a, const WrCamera *b)
{
    return a->orthographic == b->orthographic && a->fit == b->fit && same_vec(a->eye, b->eye) &&
           same_vec(a->target, b->target) && same_vec(a->up, b->up) && a->fov_deg == b->fov_deg &&
           a->size == b->size && a->frame == b->frame;
}

bool wr_scene_same_normals(const WrScene *a, const WrScene *b)
{
    if (a == b) return true;
    return memcmp(&a->shape, &b->shape, sizeof a->shape) == 0 && a->posed == b->posed &&
           same_vec(a->rotate_deg, b->rotate_deg) && a->bump == b->bump && a->scheme == b->scheme &&
           a->height == b->height && a->displaced == b->displaced && a->parallax == b->parallax &&
           a->replicate_u == b->replicate_u && a->replicate_v == b->replicate_v &&
           same_formula(&a->analytic, &b->analytic) && same_map(&a->normals, &b->normals) &&
           a->triangles == b->triangles && same_vec(a->at, b->at) && a->size == b->size &&
           same_vec(a->sizes, b->sizes) && a->hidden == b->hidden && a->still == b->still &&
           a->other_count == 0 && b->other_count == 0 && same_camera(&a->camera, &b->camera);
}
