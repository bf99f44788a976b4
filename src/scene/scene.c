#include "scene/scene.h"

#include "base/enum_rows.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "image/image.h"
#include "scene/background.h"
#include "scene/environment.h"
#include "scene/camera.h"
#include "scene/param.h"
#include "scene/tone_mapping.h"
#include "shade/slope.h"
#include "surface/data.h"
#include "surface/relief_weights.h"
#include "surface/triangles.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- Comparison of scenes that differ only in light ---- */

/* Compares the repetition; the caller compares the picture itself. */
static bool same_laid(const WrTextureSample *a, const WrTextureSample *b)
{
    return a->own == b->own && a->ru == b->ru && a->rv == b->rv;
}

static bool same_map(const WrNormalMap *a, const WrNormalMap *b)
{
    return a->image == b->image && same_laid(&a->laid, &b->laid) && a->channels == b->channels &&
           a->green_down == b->green_down && a->object == b->object && a->frame == b->frame &&
           a->strength == b->strength && a->combine == b->combine;
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

/* True if two scenes have equal normals, positions and (u,v) at all samples, so that only shading is computed
   again (E76). Every member that reaches geometry must be compared here; a missing one shows as a stale
   picture. Scenes of several objects count as different. memcmp is safe for WrShape: it is always copied
   whole. */
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

/* ---- named view ---- */

/* Names are unique: a second view of the same name replaces the first. */

int wr_scene_find_view(const WrScene *scene, const char *name)
{
    for (int i = 0; i < scene->view_count; i++)
        if (strcmp(scene->views[i].name, name) == 0) return i;
    return -1;
}

void wr_scene_name_view(WrScene *scene, const char *name, const WrSceneView *view)
{
    const int found = wr_scene_find_view(scene, name);
    if (found >= 0) {
        scene->views[found].view = *view;
        return;
    }
    const size_t count = (size_t)scene->view_count;
    scene->views = wr_realloc(scene->views, count, count + 1, sizeof *scene->views);
    scene->views[scene->view_count++] = (WrNamedView){ wr_strdup(name), *view };
}

/* Order is kept: views are listed in the order of their creation. */
void wr_scene_forget_view(WrScene *scene, int i)
{
    wr_free(scene->views[i].name);
    for (int k = i + 1; k < scene->view_count; k++) scene->views[k - 1] = scene->views[k];
    scene->view_count--;
}

static void scene_drop_views(WrScene *scene)
{
    for (int i = 0; i < scene->view_count; i++) wr_free(scene->views[i].name);
    wr_free(scene->views);
    scene->views = NULL;
    scene->view_count = 0;
}

/* Replaces the views by those of another scene; removes all views. */
static void scene_take_views(WrScene *scene, const WrScene *from)
{
    scene_drop_views(scene);
    for (int i = 0; i < from->view_count; i++)
        wr_scene_name_view(scene, from->views[i].name, &from->views[i].view);
}

/* ---- background ---- */

WR_ROWS(wr_background_names);
const char *const wr_background_names[WR_BACKGROUND_KINDS] = {
    [WR_ROW(WR_BACKGROUND_PLAIN)] = "plain",
    [WR_ROW(WR_BACKGROUND_GRADIENT)] = "gradient",
    [WR_ROW(WR_BACKGROUND_NONE)] = "none",
    [WR_ROW(WR_BACKGROUND_SURROUNDINGS)] = "surroundings",
};
WR_ROWS_END(wr_background_names, WR_BACKGROUND_KINDS);

/* Interpolates two values evenly for the eye. Above 1, where codes are saturated, it is linear in
   light.
   The codes of 8-bit sRGB are even for the eye; interpolation in linear light would look dark in the lower
   half. */
static float between(double top, double bottom, double share)
{
    if (top == bottom) return (float)top;
    if (top > 1 || bottom > 1) return (float)(top + (bottom - top) * share);
    const double a = (double)wr_srgb_encode((float)top), b = (double)wr_srgb_encode((float)bottom);
    return wr_srgb_decode((float)(a + (b - a) * share));
}

/* The first and the last row have exactly the given colours, whatever the height. */
void wr_background_row(const WrBackground *background, int row, int height, float out[3])
{
    const bool gradient = background->kind == WR_BACKGROUND_GRADIENT;
    for (int c = 0; c < 3; c++) {
        const double top = background->top[c], bottom = background->bottom[c];
        if (!gradient || row <= 0 || height <= 1) out[c] = (float)top;
        else if (row >= height - 1) out[c] = (float)bottom;
        else out[c] = between(top, bottom, row / (height - 1.0));
    }
}

bool wr_background_equal(const WrBackground *a, const WrBackground *b)
{
    return a->kind == b->kind && memcmp(a->top, b->top, sizeof a->top) == 0 &&
           (a->kind != WR_BACKGROUND_GRADIENT ||
            memcmp(a->bottom, b->bottom, sizeof a->bottom) == 0);
}

/* ---- environment ---- */

static void environment_fini(WrEnvironment *environment)
{
    wr_environment_map_free(environment->light);
    wr_free(environment->path);
    wr_free(environment->channel);
    wr_free(environment->part);
    environment->light = NULL;
    environment->path = environment->channel = environment->part = NULL;
}

/* replaces the content of `to` */
static void environment_copy(WrEnvironment *to, const WrEnvironment *from)
{
    WrEnvironment copy = *from;
    copy.light = wr_environment_map_share(from->light);
    copy.path = wr_strdup(from->path);
    copy.channel = wr_strdup(from->channel);
    copy.part = wr_strdup(from->part);
    environment_fini(to);
    *to = copy;
}

/* A new environment keeps turn and strength of the one before, so that maps can be compared. */
void wr_environment_set(WrEnvironment *environment, WrEnvironmentMapKind kind,
                        WrEnvironmentMap *light, const char *path, const char *sha256)
{
    WrEnvironment made = { .kind = kind, .light = light, .strength = 1 };
    if (kind != WR_ENVIRONMENT_MAP_OFF && environment->kind != WR_ENVIRONMENT_MAP_OFF)
        made.turn_deg = environment->turn_deg, made.strength = environment->strength;
    made.path = wr_strdup(path);
    if (sha256) memcpy(made.sha256, sha256, 64);
    environment_fini(environment);
    *environment = made;
}

/* ---- tone mapping ---- */

WR_ROWS(wr_tone_names);
const char *const wr_tone_names[WR_TONE_KINDS] = {
    [WR_ROW(WR_TONE_CLIP)] = "clip",
    [WR_ROW(WR_TONE_SOFT)] = "soft",
};
WR_ROWS_END(wr_tone_names, WR_TONE_KINDS);

/* The curve is y up to the knee k, then 1 - (1 - k)^2 / (y + 1 - 2k): value k and slope 1 at the knee, and 1
   in the limit. The clip curve has the knee at infinity and needs no branch in kernels. */
#define NO_KNEE 3.0e38f /* never reached by light */

/* k = 1/2; y = exposure in powers of two times light. */
WrToneCurve wr_tone_curve_params(const WrTone *tone)
{
    const WrDisplayView *view = tone->view && tone->view->ready ? tone->view : NULL;
    return (WrToneCurve){ .gain = (float)wr_exp2(tone->exposure),
                          .knee = tone->kind == WR_TONE_SOFT ? 0.5f : NO_KNEE,
                          .plain = !view && tone->kind == WR_TONE_CLIP && tone->exposure == 0,
                          .view = view };
}

void wr_tone_colour(const WrTone *tone, float rgb[3])
{
    const WrToneCurve curve = wr_tone_curve_params(tone);
    const float left = 1.0f - curve.knee;
    for (int c = 0; c < 3; c++) rgb[c] *= curve.gain;
    if (curve.view) wr_display_view_apply(curve.view, rgb, 1);
    for (int c = 0; c < 3; c++)
        if (curve.view) rgb[c] = wr_srgb_decode(fminf(fmaxf(rgb[c], 0.0f), 1.0f));
        else if (rgb[c] > curve.knee)
            rgb[c] = 1.0f - left * left / (rgb[c] + 1.0f - 2.0f * curve.knee);
}

bool wr_tone_equal(const WrTone *a, const WrTone *b)
{
    return a->kind == b->kind && a->exposure == b->exposure && a->view == b->view;
}

WR_ROWS(wr_light_kinds);
const WrLightKindInfo wr_light_kinds[WR_LIGHT_KINDS] = {
    [WR_ROW(WR_LIGHT_DIRECTIONAL)] = { "directional", "Far away",
                                       "a directional light, such as the sun", false },
    [WR_ROW(WR_LIGHT_POINT)] = { "point", "Point", "a point light", true },
};
WR_ROWS_END(wr_light_kinds, WR_LIGHT_KINDS);

const char *const wr_normal_frame_names[WR_FRAME_COUNT] = { "auto", "gradient", "mikk", "lecture",
                                                            NULL };

const char *const wr_camera_names[2] = { "perspective", "orthographic" };

WR_ROWS(wr_tolerance_names);
const char *const wr_tolerance_names[WR_TOLERANCE_COUNT] = {
    [WR_ROW(WR_TOLERANCE_NONE)] = "off",
    [WR_ROW(WR_TOLERANCE_RMS)] = "rms",
    [WR_ROW(WR_TOLERANCE_MAX)] = "max",
    [WR_ROW(WR_TOLERANCE_TIME)] = "time",
};
WR_ROWS_END(wr_tolerance_names, WR_TOLERANCE_COUNT);

WrScene *wr_scene_new(void)
{
    WrScene *scene = wr_alloc(1, sizeof *scene);
    scene->refs = 1;
    wr_shape_default(WR_SURFACE_plane, &scene->shape);
    scene->bump = WR_BUMP_BLINN;
    scene->scheme = WR_SCHEME_CENTRAL;
    scene->size = 1;
    wr_scene_params_reset(scene, false);
    scene->lights = wr_alloc(1, sizeof *scene->lights);
    scene->lights[0].kind = WR_LIGHT_DIRECTIONAL;
    wr_scene_params_reset(scene->lights, true);
    scene->light_count = 1;
    scene->dials = wr_dials_default();
    scene->grain = wr_grains[WR_SOLID_TEXTURE_OFF].usual;
    return scene;
}

/* Copies `count` elements to a new block; NULL for none. */
static void *copied(const void *block, int count, size_t size)
{
    if (!block || count <= 0) return NULL;
    void *copy = wr_alloc((size_t)count, size);
    memcpy(copy, block, (size_t)count * size);
    return copy;
}

static WrTextureSample laid_copy(const WrTextureSample *laid)
{
    WrTextureSample copy = *laid;
    copy.path = wr_strdup(laid->path);
    copy.channel = wr_strdup(laid->channel);
    copy.part = wr_strdup(laid->part);
    return copy;
}

void wr_texture_sample_fini(WrTextureSample *laid)
{
    wr_free(laid->path);
    wr_free(laid->channel);
    wr_free(laid->part);
    *laid = (WrTextureSample){ 0 };
}

/* Copies members one by one: owned blocks are duplicated, immutable objects (images, triangles, other objects)
   shared. A new member that is missing here stays 0 in every copy. */
WrScene *wr_scene_clone(const WrScene *scene)
{
    WrScene *clone = wr_alloc(1, sizeof *clone);
    clone->refs = 1;
    wr_scene_set_shape(clone, &scene->shape);
    clone->posed = scene->posed;
    clone->rotate_deg = scene->rotate_deg;
    clone->bump = scene->bump;
    clone->scheme = scene->scheme;
    clone->height = scene->height;
    clone->displaced = scene->displaced;
    clone->parallax = scene->parallax;
    clone->replicate_u = scene->replicate_u;
    clone->replicate_v = scene->replicate_v;
    clone->analytic = scene->analytic;
    clone->analytic.terms =
        copied(scene->analytic.terms, scene->analytic.count, sizeof *scene->analytic.terms);
    clone->material = scene->material;
    clone->grain = scene->grain;
    clone->colour = scene->colour ? wr_image_share(scene->colour) : NULL;
    clone->colour_laid = laid_copy(&scene->colour_laid);
    clone->colouring = scene->colouring;
    clone->normals = scene->normals;
    if (scene->normals.image) wr_image_share(scene->normals.image);
    clone->normals.laid = laid_copy(&scene->normals.laid);
    for (int k = 0; k < WR_FACET_KINDS; k++) {
        const WrFacetMap *map = &scene->facets[k];
        clone->facets[k] =
            (WrFacetMap){ map->image ? wr_image_share(map->image) : NULL, laid_copy(&map->laid) };
    }
    if (scene->triangles) clone->triangles = wr_triangles_share(scene->triangles);
    if (scene->mesh_source) clone->mesh_source = wr_triangles_share(scene->mesh_source);
    clone->projection = scene->projection;
    clone->triangles_path = wr_strdup(scene->triangles_path);
    memcpy(clone->triangles_sha256, scene->triangles_sha256, sizeof clone->triangles_sha256);
    clone->form_layer = wr_strdup(scene->form_layer);
    clone->form_key = scene->form_key;
    wr_scene_set_mask(clone, scene->mask_layer, scene->mask, scene->mask_key);
    clone->name = wr_strdup(scene->name);
    clone->at = scene->at;
    clone->size = scene->size;
    clone->sizes = scene->sizes;
    clone->hidden = scene->hidden;
    clone->still = scene->still;
    clone->layer = wr_strdup(scene->layer);
    clone->others = copied(scene->others, scene->other_count, sizeof *scene->others);
    for (int i = 0; i < scene->other_count; i++) wr_scene_share(scene->others[i]);
    clone->other_count = scene->other_count;
    clone->chosen = scene->chosen;
    wr_scene_take_shared(clone, scene);
    return clone;
}

/* The members that belong to the scene and not to an object: lights, camera, dials, background and so on. */
void wr_scene_take_shared(WrScene *scene, const WrScene *from)
{
    wr_free(scene->lights);
    scene->lights_given = from->lights_given;
    scene->lights = copied(from->lights, from->light_count, sizeof *from->lights);
    scene->light_count = from->light_count;
    scene->camera = from->camera;
    scene_take_views(scene, from);
    scene->dials = from->dials;
    scene->tolerance = from->tolerance;
    scene->background = from->background;
    environment_copy(&scene->environment, &from->environment);
    scene->tone = from->tone;
    scene->cell = from->cell;
    scene->sheet = from->sheet;
}

bool wr_cell_size_given(const WrCellSize *cell)
{
    return cell->w != 1 || cell->h != 1 || cell->mm || cell->height != 1;
}

double wr_scene_relief(const WrScene *scene)
{
    return scene->cell.mm ? scene->cell.height : scene->height;
}

void wr_scene_drop_colour(WrScene *scene)
{
    wr_image_free(scene->colour);
    wr_texture_sample_fini(&scene->colour_laid);
    scene->colour = NULL;
    scene->colouring = (WrHeightColormap){ 0 };
}

/* own: repetitions of this picture alone; otherwise it follows the table's. */
void wr_scene_repeat(const WrScene *scene, const WrTextureSample *laid, double *ru, double *rv)
{
    *ru = laid->own ? laid->ru : scene->replicate_u;
    *rv = laid->own ? laid->rv : scene->replicate_v;
}

/* Relaxed: a new reference needs an existing one, so no other memory is ordered by it. The last release
   acquires, so that all writes of other threads are visible before memory is freed. */
WrScene *wr_scene_share(const WrScene *scene)
{
    WrScene *shared = (WrScene *)scene; /* only the reference count changes */
    __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_scene_free(WrScene *scene)
{
    if (!scene || __atomic_sub_fetch(&scene->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_surface_data_free((WrSurfaceData *)scene->shape.data);
    wr_free(scene->analytic.terms);
    if (scene->colour) wr_image_free(scene->colour);
    wr_texture_sample_fini(&scene->colour_laid);
    if (scene->normals.image) wr_image_free(scene->normals.image);
    wr_texture_sample_fini(&scene->normals.laid);
    for (int k = 0; k < WR_FACET_KINDS; k++) {
        wr_image_free(scene->facets[k].image);
        wr_texture_sample_fini(&scene->facets[k].laid);
    }
    wr_free(scene->name);
    wr_free(scene->layer);
    for (int i = 0; i < scene->other_count; i++) wr_scene_free(scene->others[i]);
    wr_free(scene->others);
    wr_triangles_free(scene->triangles);
    wr_triangles_free(scene->mesh_source);
    wr_free(scene->triangles_path);
    wr_free(scene->form_layer);
    wr_free(scene->mask_layer);
    wr_field_free(scene->mask);
    wr_free(scene->lights);
    environment_fini(&scene->environment);
    scene_drop_views(scene);
    wr_free(scene);
}

/* shared first, then freed: the shape may be the scene's own. */
void wr_scene_set_shape(WrScene *scene, const WrShape *shape)
{
    const WrSurfaceData *old = scene->shape.data, *shared = wr_surface_data_share(shape->data);
    scene->shape = *shape;
    wr_shape_borrow_data(&scene->shape, shared);
    wr_surface_data_free((WrSurfaceData *)old);
}

/* of_one: the pose of a single object is part of its view; among several, only the camera is. */
WrSceneView wr_scene_view(const WrScene *scene)
{
    const bool one = scene->other_count == 0;
    WrSceneView view = { .of_one = one, .camera = scene->camera };
    if (one) view.posed = scene->posed, view.rotate_deg = scene->rotate_deg;
    return view;
}

/* A pose is saved only in a view of a single object; in a scene of several it would turn whichever is active. */
void wr_scene_set_pose(WrScene *scene, const WrSceneView *view)
{
    scene->camera = view->camera;
    if (!view->of_one || scene->other_count > 0) return;
    scene->posed = view->posed;
    scene->rotate_deg = view->rotate_deg;
}

static bool equal3(WrVec3 a, WrVec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool wr_scene_view_equal(const WrSceneView *a, const WrSceneView *b)
{
    const WrCamera *p = &a->camera, *q = &b->camera;
    return a->of_one == b->of_one && a->posed == b->posed &&
           (!a->posed || equal3(a->rotate_deg, b->rotate_deg)) &&
           p->orthographic == q->orthographic && p->fit == q->fit && equal3(p->eye, q->eye) &&
           equal3(p->target, q->target) && equal3(p->up, q->up) && p->fov_deg == q->fov_deg &&
           p->size == q->size && p->frame == q->frame;
}

/* Table coordinate: periodic axes are reduced to 0..1; beyond the ends of a clamped one F is constant,
 * so that replicas there do not repeat. */
static double table_parameter(double u, double replicate, bool clamped)
{
    return clamped ? replicate * u : wr_field_reduce(u, replicate);
}

/* f = h T(ru u, rv v), fu = h ru dT/du: the chain rule, because derivatives are by the patch's parameters
   (DESIGN). A formula has period 1 on both axes. Results are bounded to the range of float, so that no
   infinity enters a normal (HC15). */
void wr_scene_height(const WrScene *scene, const WrField *field, double u, double v, double *f,
                     double *fu, double *fv)
{
    double ru = scene->replicate_u, rv = scene->replicate_v;
    double value = 0, slope_u = 0, slope_v = 0;
    if (scene->analytic.kind != WR_ANALYTIC_OFF) {
        double x = wr_field_reduce(u, ru), y = wr_field_reduce(v, rv);
        wr_analytic_sample(&scene->analytic, x, y, &value, &slope_u, &slope_v);
    } else {
        double x = table_parameter(u, ru, wr_field_wrap_u(field) == WR_WRAP_CLAMP);
        double y = table_parameter(v, rv, wr_field_wrap_v(field) == WR_WRAP_CLAMP);
        wr_field_sample(field, scene->scheme, 1, &x, &y, &value, &slope_u, &slope_v);
    }
    if (f) *f = wr_slope_bounded(scene->height * value);
    if (fu) *fu = wr_slope_of(slope_u, scene->height, ru);
    if (fv) *fv = wr_slope_of(slope_v, scene->height, rv);
}

/* Runs of WR_HEIGHTS_RUN points keep the scratch arrays on the stack and in the first-level cache. Formulas go
   point by point. */
void wr_scene_heights(const WrScene *scene, const WrField *field, int count, const double *u,
                      const double *v, double *f)
{
    double x[WR_HEIGHTS_RUN], y[WR_HEIGHTS_RUN];
    const bool formula = scene->analytic.kind != WR_ANALYTIC_OFF;
    for (int i = 0; i < count && formula; i++)
        wr_scene_height(scene, field, u[i], v[i], &f[i], NULL, NULL);
    for (int from = 0; from < count && !formula; from += WR_HEIGHTS_RUN) {
        const int n = count - from < WR_HEIGHTS_RUN ? count - from : WR_HEIGHTS_RUN;
        for (int i = 0; i < n; i++) {
            x[i] = table_parameter(u[from + i], scene->replicate_u,
                                   wr_field_wrap_u(field) == WR_WRAP_CLAMP);
            y[i] = table_parameter(v[from + i], scene->replicate_v,
                                   wr_field_wrap_v(field) == WR_WRAP_CLAMP);
        }
        wr_field_sample(field, scene->scheme, (size_t)n, x, y, f + from, NULL, NULL);
        for (int i = from; i < from + n; i++) f[i] = wr_slope_bounded(scene->height * f[i]);
    }
}

void wr_scene_weighted_height(const WrScene *scene, const WrField *field, const WrTriangles *mesh,
                              int32_t face, double b1, double b2, double *f, double *fu, double *fv)
{
    WrReliefTap taps[WR_RELIEF_TAPS];
    WrReliefSum sum = { 0 };
    const int count = wr_relief_taps(mesh, face, b1, b2, taps);
    for (int k = 0; k < count; k++) {
        double t, tu, tv;
        wr_scene_height(scene, field, taps[k].u, taps[k].v, &t, &tu, &tv);
        wr_relief_add(&sum, &taps[k], t, tu, tv);
    }
    *f = sum.f;
    wr_relief_slopes(mesh, face, &sum, fu, fv);
}

/* The part of a material that its tables of albedo depend on. */
WrReflectance wr_scene_reflectance(const WrMaterial *m)
{
    return (WrReflectance){ m->model, m->energy, m->shininess, m->roughness, m->metalness, m->ior };
}

void wr_scene_gloss(const WrMaterial *m, WrEnvironmentBrdf *gloss)
{
    const WrReflectance of = wr_scene_reflectance(m);
    WrMatter matter;
    wr_matter_init(&matter, &of);
    wr_environment_brdf_init(gloss, &of, &matter, m->specular, m->tint, m->gate);
}

/* The reflection model's constants, integrated once for each material; kd, ks and the colour are plain copies,
   so changing them costs nothing. */
void wr_scene_matter(const WrMaterial *m, WrMatter *matter)
{
    const WrReflectance of = wr_scene_reflectance(m);
    wr_matter_init(matter, &of);
    matter->kd = m->diffuse, matter->ks = m->specular;
    matter->colour[0] = m->colour.x, matter->colour[1] = m->colour.y;
    matter->colour[2] = m->colour.z;
}
