/* The table of benchmark sections and their pictures. */
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "bench/sections.h"
#include "field/scheme_list.h"
#include "image/image.h"
#include "render/kernels/kern.h"
#include "scene/dials.h"
#include "scene/scene.h"
#include "shade/reflection_models.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

#define TABLE 512

/* A row of the reference scene; NULL and an error if out of memory or rows. */
static WrBenchPicture *add(WrBenchSections *all, const char *name, int base, const char *surface,
                           WrBenchMode mode, WrError *err)
{
    if (all->count == WR_BENCH_PICTURES) {
        wr_fail(err, "a section of the bench has at most %d pictures", WR_BENCH_PICTURES);
        return NULL;
    }
    WrScene *scene = wr_bench_scene(surface, mode, all->fast, err);
    if (!scene) return NULL;
    WrBenchPicture *p = &all->picture[all->count++];
    *p = (WrBenchPicture){ .base = base, .scene = scene, .table = TABLE, .effect = -1 };
    snprintf(p->name, sizeof p->name, "%s", name);
    return p;
}

static WrBenchPicture *add_bump(WrBenchSections *all, const char *name, int base, WrError *err)
{
    return add(all, name, base, "sphere", WR_BENCH_BUMP, err);
}

static const char *const surfaces[] = { "sphere", "bezier", "torus" };

static bool fill_surfaces(WrBenchSections *all, WrError *err)
{
    static const WrBenchMode modes[] = { WR_BENCH_PHONG, WR_BENCH_TEXTURE, WR_BENCH_BUMP,
                                         WR_BENCH_BUMP_TEXTURE };
    for (int s = 0; s < 3; s++) {
        const int smooth = all->count;
        for (int m = 0; m < 4; m++) {
            char name[64];
            snprintf(name, sizeof name, "%s %s", surfaces[s],
                     m == 0 ? "smooth" : wr_bench_modes[modes[m]]);
            if (!add(all, name, smooth, surfaces[s], modes[m], err)) return false;
        }
    }
    return true;
}

static bool fill_schemes(WrBenchSections *all, WrError *err)
{
    for (int s = 0; s < WR_SCHEME_COUNT; s++) {
        WrBenchPicture *p = add_bump(all, wr_schemes[s].name, WR_SCHEME_CENTRAL, err);
        if (!p) return false;
        p->scene->scheme = (WrScheme)s;
    }
    return true;
}

static bool fill_normals(WrBenchSections *all, WrError *err)
{
    for (int m = 0; m < WR_BUMP_COUNT; m++) {
        WrBenchPicture *p = add_bump(all, wr_bumps[m].name, WR_BUMP_BLINN, err);
        if (!p) return false;
        p->scene->bump = (WrBumpMode)m;
    }
    return true;
}

/* ---- anti-aliasing ---- */

typedef struct Aliasing {
    const char *name;
    WrAntialias aa;
    int samples;
    WrSpread spread;
    WrFootprint footprint;
    WrMoments moments;
    WrRefine refine;
} Aliasing;

static const Aliasing aliasing[] = {
    { .name = "point", WR_AA_POINT, 1 },
    { .name = "filter, isotropic", WR_AA_FILTER, 1 },
    { .name = "filter, anisotropic", WR_AA_FILTER, 1, .footprint = WR_FOOTPRINT_ANISOTROPIC },
    { .name = "moments, toksvig", WR_AA_MOMENTS, 1 },
    { .name = "moments, lean", WR_AA_MOMENTS, 1, .moments = WR_MOMENTS_LEAN },
    { .name = "moments, lean, anisotropic",
      WR_AA_MOMENTS,
      1,
      .footprint = WR_FOOTPRINT_ANISOTROPIC,
      .moments = WR_MOMENTS_LEAN },
    { .name = "supersample 2x2", WR_AA_SUPERSAMPLE, 2 },
    { .name = "supersample 4x4", WR_AA_SUPERSAMPLE, 4 },
    { .name = "supersample 4x4, jittered", WR_AA_SUPERSAMPLE, 4, .spread = WR_SPREAD_JITTERED },
    { .name = "supersample 8x8", WR_AA_SUPERSAMPLE, 8 },
    { .name = "adaptive to 2x2, contrast", WR_AA_ADAPTIVE, 2 },
    { .name = "adaptive to 4x4, contrast", WR_AA_ADAPTIVE, 4 },
    { .name = "adaptive to 4x4, jittered", WR_AA_ADAPTIVE, 4, .spread = WR_SPREAD_JITTERED },
    { .name = "adaptive to 8x8, contrast", WR_AA_ADAPTIVE, 8 },
    { .name = "adaptive to 4x4, bound", WR_AA_ADAPTIVE, 4, .refine = WR_REFINE_BOUND },
};

static void take_aliasing(WrDials *dials, const Aliasing *a)
{
    dials->aa = a->aa;
    dials->samples = a->samples;
    dials->spread = a->spread;
    dials->footprint = a->footprint;
    dials->moments = a->moments;
    dials->refine = a->refine;
}

static bool fill_aliasing(WrBenchSections *all, WrError *err)
{
    for (size_t i = 0; i < sizeof aliasing / sizeof *aliasing; i++) {
        WrBenchPicture *p = add_bump(all, aliasing[i].name, 0, err);
        if (!p) return false;
        take_aliasing(&p->scene->dials, &aliasing[i]);
    }
    return true;
}

/* ---- effects ---- */

typedef void (*Change)(WrScene *scene);

static void same(WrScene *scene)
{
    (void)scene;
}

static void facets(WrScene *scene)
{
    scene->material.model = WR_REFLECT_GGX;
}

/* Environment light in place of the lamp. */
static void under_sky(WrScene *scene)
{
    scene->light_count = 0;
    wr_environment_set(&scene->environment, WR_ENVIRONMENT_MAP_SKY,
                       wr_environment_map_built(WR_ENVIRONMENT_MAP_SKY, NULL), NULL, NULL);
}

static void metal(WrScene *scene)
{
    facets(scene);
    scene->material.metalness = 1;
}

/* Plastic: most of it shows no highlight. */
static void faint(WrScene *scene)
{
    facets(scene);
    scene->material.roughness = 0.2;
    scene->dials.faint = 1e-4;
}

static void wooden(WrScene *scene)
{
    scene->grain = wr_grains[WR_SOLID_TEXTURE_WOOD].usual;
}

static void wooden_filtered(WrScene *scene)
{
    wooden(scene);
    scene->dials.aa = WR_AA_FILTER;
}

static void rough(WrScene *scene)
{
    facets(scene);
    wooden(scene);
    scene->grain.drives = WR_SOLID_TEXTURE_ROUGHENS;
}

/* Roughness and metalness maps with waves. */
static void worn(WrScene *scene)
{
    facets(scene);
    for (int k = 0; k < WR_FACET_KINDS; k++) {
        WrImage *image = wr_image_new(256, 256, 1, NULL);
        for (int i = 0; i < 256 * 256 && image; i++) {
            const int phase = k ? i / 256 : i % 256;
            image->data[i] = (float)(0.4 + 0.3 * sin(phase * 0.39269908169872414));
        }
        scene->facets[k].image = image;
    }
}

static void embossed(WrScene *scene)
{
    wooden(scene);
    scene->grain.drives = WR_SOLID_TEXTURE_BUMPS;
}

static void objects_hide(WrScene *scene)
{
    scene->lights[0].shadow = true;
}

static void displaced(WrScene *scene)
{
    scene->displaced = true;
}

static void parallax(WrScene *scene)
{
    scene->parallax = true;
}

static void three_objects(WrScene *scene)
{
    WrScene **others = wr_alloc(2, sizeof *others);
    for (int i = 0; i < 2; i++) {
        others[i] = wr_scene_clone(scene);
        others[i]->at = (WrVec3){ i ? 0.7 : -0.7, 0.2, i ? 0.4 : -0.4 };
        others[i]->size = 0.5;
    }
    scene->others = others;
    scene->other_count = 2;
}

static void three_shadowed(WrScene *scene)
{
    three_objects(scene);
    scene->lights[0].shadow = true;
}

static void mapped(WrScene *scene)
{
    WrNormalMap *map = &scene->normals;
    map->image = wr_image_new(256, 256, 3, NULL);
    map->strength = 1;
    for (int i = 0; i < 256 * 256 && map->image; i++) {
        /* Slope 0.3 sin(2 pi 16 u): 16 waves over 256 texels; (x, 0, 1) normalised. */
        const double x = 0.3 * sin(i % 256 * 0.39269908169872414), z = 1 / sqrt(1 + x * x);
        map->image->data[3 * i] = (float)(x * z);
        map->image->data[3 * i + 2] = (float)z;
    }
}

static void reoriented(WrScene *scene)
{
    mapped(scene);
    scene->normals.combine = WR_COMBINE_REORIENTED;
}

static void bilinear(WrScene *scene)
{
    scene->scheme = WR_SCHEME_BILINEAR;
}

static void far_replicated(WrScene *scene)
{
    scene->replicate_u = scene->replicate_v = 2048;
}

static void invariant(WrScene *scene)
{
    scene->bump = WR_BUMP_INVARIANT;
}

static void exact(WrScene *scene)
{
    scene->bump = WR_BUMP_EXACT;
}

static void shadowed(WrScene *scene)
{
    scene->material.shadow = true;
}

static void raised(WrScene *scene)
{
    scene->displaced = true;
}

static void supersampled(WrScene *scene)
{
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    scene->dials.samples = 4;
}

static void bounded(WrScene *scene)
{
    scene->dials.aa = WR_AA_ADAPTIVE;
    scene->dials.samples = 4;
    scene->dials.refine = WR_REFINE_BOUND;
}

static void filtered(WrScene *scene)
{
    scene->dials.aa = WR_AA_FILTER;
}

static void moments(WrScene *scene)
{
    scene->dials.aa = WR_AA_MOMENTS;
}

static void near_lamp(WrScene *scene)
{
    scene->lights[0].kind = WR_LIGHT_POINT;
    scene->lights[0].where = (WrVec3){ -2, 2.5, 3 };
}

static void occluded(WrScene *scene)
{
    scene->material.occlusion = true;
}

static void smooth(WrScene *scene)
{
    scene->bump = WR_BUMP_NONE;
}

static void from_behind(WrScene *scene)
{
    scene->lights[0].where = (WrVec3){ 0.2, 0.9, -1 };
}

/* Add another object of the same kind at that position. */
static void add_another(WrScene *scene, WrVec3 at, double size)
{
    WrScene *other = wr_scene_clone(scene);
    other->at = at;
    other->size = size;
    scene->others = wr_alloc(1, sizeof *scene->others);
    scene->others[scene->other_count++] = other;
}

static void beside(WrScene *scene)
{
    add_another(scene, (WrVec3){ 0.6, 0.1, -0.4 }, 1);
}

static void behind(WrScene *scene)
{
    add_another(scene, (WrVec3){ 0, 0, -2 }, 0.5);
}

static void to_horizon(WrScene *scene)
{
    scene->shape.value[2] = 1;
}

static void orthographic(WrScene *scene)
{
    scene->camera.orthographic = true;
    scene->camera.size = 2;
}

static void rounded(WrScene *scene)
{
    scene->dials.heights = WR_HEIGHTS_HALF;
}

static void doubled(WrScene *scene)
{
    scene->dials.shading = WR_SHADING_DOUBLE;
}

static void halved(WrScene *scene)
{
    scene->dials.shading = WR_SHADING_HALF;
}

/* A picture with an effect and the same without. If `without` is NULL, the effect is forced off; if it is a surface's
   name, that surface does not need the effect. `forced`: the scene does not need the effect, which is forced on. */
typedef struct EffectCase {
    const char *surface;
    WrBenchMode mode;
    Change with, without;
    const char *other;
    bool forced;
    WrBenchView view; /* without it */
} EffectCase;

#define BUMPED .surface = "sphere", .mode = WR_BENCH_BUMP
#define SMOOTH .surface = "sphere", .mode = WR_BENCH_PHONG
#define MESHED .surface = "mesh", .mode = WR_BENCH_BUMP

WR_ROWS(effects);
static const EffectCase effects[WR_EFFECT_COUNT] = {
    [WR_ROW(WR_EFFECT_DIFFUSE)] = { BUMPED, .with = same },
    [WR_ROW(WR_EFFECT_SPECULAR)] = { BUMPED, .with = same },
    [WR_ROW(WR_EFFECT_MODEL)] = { BUMPED, .with = facets, .without = same },
    [WR_ROW(WR_EFFECT_KEPT)] = { BUMPED, .with = metal, .forced = true },
    [WR_ROW(WR_EFFECT_SURROUND)] = { BUMPED, .with = under_sky, .without = same },
    [WR_ROW(WR_EFFECT_HARMONICS)] = { BUMPED, .with = under_sky },
    [WR_ROW(WR_EFFECT_MIRROR)] = { BUMPED, .with = under_sky },
    [WR_ROW(WR_EFFECT_BLUR)] = { BUMPED, .with = under_sky },
    [WR_ROW(WR_EFFECT_COLOUR)] = { .surface = "sphere", .mode = WR_BENCH_TEXTURE, .with = same },
    [WR_ROW(WR_EFFECT_TINT)] = { .surface = "sphere", .mode = WR_BENCH_TEXTURE, .with = filtered },
    [WR_ROW(WR_EFFECT_FACETS)] = { BUMPED, .with = worn, .without = facets },
    [WR_ROW(WR_EFFECT_VARIED)] = { BUMPED, .with = rough, .without = facets },
    [WR_ROW(WR_EFFECT_EMBOSSED)] = { BUMPED, .with = embossed, .without = same },
    [WR_ROW(WR_EFFECT_GRAIN)] = { BUMPED, .with = wooden, .without = same },
    [WR_ROW(WR_EFFECT_OCTAVES)] = { BUMPED, .with = wooden },
    [WR_ROW(WR_EFFECT_FADED)] = { BUMPED, .with = wooden_filtered },
    [WR_ROW(WR_EFFECT_NORMALS)] = { BUMPED, .with = mapped },
    [WR_ROW(WR_EFFECT_DISPLACED)] = { BUMPED, .with = displaced, .without = exact, .forced = true },
    [WR_ROW(WR_EFFECT_PARALLAX)] = { BUMPED, .with = parallax, .without = same, .forced = true },
    [WR_ROW(WR_EFFECT_BUMP)] = { BUMPED, .with = same },
    [WR_ROW(WR_EFFECT_REORIENTED)] = { BUMPED, .with = reoriented },
    [WR_ROW(WR_EFFECT_GRADIENT)] = { BUMPED, .with = same, .without = bilinear },
    [WR_ROW(WR_EFFECT_WIDE)] = { BUMPED, .with = far_replicated },
    [WR_ROW(WR_EFFECT_INVARIANT)] = { BUMPED, .with = invariant },
    [WR_ROW(WR_EFFECT_EXACT)] = { BUMPED, .with = exact },
    [WR_ROW(WR_EFFECT_CURVATURE)] = { BUMPED, .with = exact, .without = same },
    [WR_ROW(WR_EFFECT_SHADOW)] = { BUMPED, .with = shadowed, .without = same },
    [WR_ROW(WR_EFFECT_CAST)] = { .surface = "torus",
                                 .mode = WR_BENCH_BUMP,
                                 .with = objects_hide,
                                 .without = same },
    [WR_ROW(WR_EFFECT_OCCLUSION)] = { BUMPED, .with = occluded, .without = same },
    [WR_ROW(WR_EFFECT_SAMPLES)] = { BUMPED, .with = supersampled },
    [WR_ROW(WR_EFFECT_BOUND)] = { BUMPED, .with = bounded },
    [WR_ROW(WR_EFFECT_FILTER)] = { BUMPED, .with = filtered },
    [WR_ROW(WR_EFFECT_BACK)] = { BUMPED, .with = same, .forced = true },
    [WR_ROW(WR_EFFECT_DEPTH)] = { .surface = "torus",
                                  .mode = WR_BENCH_PHONG,
                                  .with = same,
                                  .other = "sphere" },
    [WR_ROW(WR_EFFECT_NEWTON)] = { .surface = "torus", .mode = WR_BENCH_BUMP, .with = same },
    [WR_ROW(WR_EFFECT_PERSPECTIVE)] = { BUMPED, .with = same, .without = orthographic },
    [WR_ROW(WR_EFFECT_AGAIN)] = { BUMPED, same, same, .view = WR_BENCH_RESTS },
    [WR_ROW(WR_EFFECT_STEADY)] = { BUMPED, same, same, .view = WR_BENCH_RELIT },
    [WR_ROW(WR_EFFECT_BESIDE)] = { BUMPED, .with = same, .forced = true },
    [WR_ROW(WR_EFFECT_SPREAD)] = { BUMPED, .with = moments },
    [WR_ROW(WR_EFFECT_WIDENED)] = { BUMPED, .with = moments, .forced = true },
    [WR_ROW(WR_EFFECT_FACED)] = { BUMPED, .with = facets, .forced = true },
    [WR_ROW(WR_EFFECT_FAINT)] = { BUMPED, .with = faint, .forced = true },
    [WR_ROW(WR_EFFECT_ROUNDED)] = { BUMPED, .with = rounded },
    [WR_ROW(WR_EFFECT_DOUBLE)] = { BUMPED, .with = doubled },
    [WR_ROW(WR_EFFECT_HALF)] = { BUMPED, .with = halved },
    [WR_ROW(WR_EFFECT_PARAMETERS)] = { SMOOTH, .with = same, .forced = true },
    [WR_ROW(WR_EFFECT_TANGENTS)] = { SMOOTH, .with = same, .forced = true },
    [WR_ROW(WR_EFFECT_DARK)] = { BUMPED, .with = from_behind, .forced = true },
    [WR_ROW(WR_EFFECT_GROUND)] = { BUMPED, .with = same, .without = smooth },
    [WR_ROW(WR_EFFECT_HIDDEN)] = { BUMPED, .with = behind, .forced = true },
    [WR_ROW(WR_EFFECT_BETWEEN)] = { BUMPED, .with = beside, .without = same },
    [WR_ROW(WR_EFFECT_SMOOTH)] = { MESHED, .with = same, .forced = true },
    [WR_ROW(WR_EFFECT_BLOCKS)] = { MESHED, .with = same, .other = "sphere" },
    [WR_ROW(WR_EFFECT_HORIZON)] = { .surface = "plane",
                                    .mode = WR_BENCH_BUMP,
                                    .with = to_horizon,
                                    .without = same },
};
WR_ROWS_END(effects, WR_EFFECT_COUNT);

static bool add_effect(WrBenchSections *all, int effect, bool with, WrError *err)
{
    const EffectCase *e = &effects[effect];
    const char *surface = !with && e->other ? e->other : e->surface;
    char name[64];
    snprintf(name, sizeof name, "%s%s", with ? "" : "without ", wr_effects[effect].name);
    WrBenchPicture *p = add(all, name, all->count - (with ? 1 : 0), surface, e->mode, err);
    if (!p) return false;
    p->effect = effect;
    (with || !e->without ? e->with : e->without)(p->scene);
    if (with && e->forced) p->force[effect] = WR_FORCE_ON;
    if (!with && !e->forced && !e->without && !e->other) p->force[effect] = WR_FORCE_OFF;
    if (!with) p->view = e->view;
    return true;
}

static bool fill_effects(WrBenchSections *all, WrError *err)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        if (!add_effect(all, e, false, err) || !add_effect(all, e, true, err)) return false;
    return true;
}

/* ---- the rest ---- */

static bool fill_isa(WrBenchSections *all, WrError *err)
{
    static const char *const names[] = { "ref", "v1", "v2", "v3", "v4" };
    for (int fast = 0; fast < 2; fast++)
        for (size_t i = fast ? 3 : 0; i < sizeof names / sizeof *names; i++) {
            WrError lacks;
            char name[64];
            if (!wr_kernels_get(names[i], fast, &lacks)) continue;
            snprintf(name, sizeof name, "%s, %s", names[i], fast ? "fast" : "exact");
            WrBenchPicture *p = add_bump(all, name, 0, err);
            if (!p) return false;
            p->isa = names[i];
            p->scene->dials.arithmetic = fast ? WR_ARITHMETIC_FAST : WR_ARITHMETIC_EXACT;
        }
    return true;
}

/* Scenes that take the loops of src/render/simd/, each beside the same without them. */
static bool fill_simd(WrBenchSections *all, WrError *err)
{
    static const struct {
        const char *name, *surface;
        WrBenchMode mode;
        Change change;
    } rows[] = { { "sphere smooth", "sphere", WR_BENCH_PHONG, same },
                 { "sphere colour", "sphere", WR_BENCH_TEXTURE, same },
                 { "sphere bump", "sphere", WR_BENCH_BUMP, same },
                 { "sphere bump and colour", "sphere", WR_BENCH_BUMP_TEXTURE, same },
                 { "sphere bump, filter", "sphere", WR_BENCH_BUMP, filtered },
                 { "sphere bump, moments", "sphere", WR_BENCH_BUMP, moments },
                 { "sphere bump, near lamp", "sphere", WR_BENCH_BUMP, near_lamp },
                 { "sphere bump, 4 x 4 samples", "sphere", WR_BENCH_BUMP, supersampled },
                 { "patch smooth", "bezier", WR_BENCH_PHONG, same },
                 { "patch bump", "bezier", WR_BENCH_BUMP, same },
                 { "torus smooth", "torus", WR_BENCH_PHONG, same },
                 { "torus bump", "torus", WR_BENCH_BUMP, same },
                 { "cylinder bump", "cylinder", WR_BENCH_BUMP, same },
                 { "plane bump", "plane", WR_BENCH_BUMP, same } };
    for (int i = 0; i < 2 * WR_LENGTH(rows); i++) {
        char name[64];
        snprintf(name, sizeof name, "%s%s", rows[i / 2].name, i % 2 ? ", by hand" : "");
        WrBenchPicture *p =
            add(all, name, all->count - i % 2, rows[i / 2].surface, rows[i / 2].mode, err);
        if (!p) return false;
        rows[i / 2].change(p->scene);
        p->staged = i % 2 == 0;
    }
    return true;
}

static bool fill_plan(WrBenchSections *all, WrError *err)
{
    static const WrBenchMode modes[] = { WR_BENCH_PHONG, WR_BENCH_BUMP };
    for (int s = 0; s < 3; s++)
        for (int m = 0; m < 2; m++)
            for (int planned = 0; planned < 2; planned++) {
                char name[64];
                snprintf(name, sizeof name, "%s %s, %s", surfaces[s], m ? "bump" : "smooth",
                         planned ? "planned" : "full");
                WrBenchPicture *p =
                    add(all, name, all->count - planned, surfaces[s], modes[m], err);
                if (!p) return false;
                p->full = !planned;
            }
    return true;
}

static bool fill_views(WrBenchSections *all, const WrBenchView *views, const char *const *names,
                       int count, WrError *err)
{
    static const int tables[] = { 512, 4096 };
    for (int t = 0; t < 2; t++) {
        const int base = all->count;
        for (int i = 0; i < count; i++) {
            char name[64];
            snprintf(name, sizeof name, "table %d, %s", tables[t], names[i]);
            WrBenchPicture *p = add_bump(all, name, base, err);
            if (!p) return false;
            p->table = tables[t];
            p->view = views[i];
        }
    }
    return true;
}

static bool fill_relit(WrBenchSections *all, WrError *err)
{
    static const struct {
        const char *name, *surface;
        WrBenchMode mode;
        void (*change)(WrScene *scene);
    } rows[] = { { "bezier", "bezier", WR_BENCH_BUMP, NULL },
                 { "torus", "torus", WR_BENCH_BUMP, NULL },
                 { "torus, painted", "torus", WR_BENCH_BUMP_TEXTURE, NULL },
                 { "three tori", "torus", WR_BENCH_BUMP, three_objects },
                 { "torus, moments", "torus", WR_BENCH_BUMP, moments },
                 { "torus, relief shadow", "torus", WR_BENCH_BUMP, shadowed },
                 { "three tori, shadows", "torus", WR_BENCH_BUMP, three_shadowed },
                 { "sphere, 4 x 4 samples", "sphere", WR_BENCH_BUMP, supersampled } };
    for (int i = 0; i < 2 * WR_LENGTH(rows); i++) {
        char name[64];
        snprintf(name, sizeof name, "%s, %s", rows[i / 2].name, i % 2 ? "relit" : "turning");
        WrBenchPicture *p =
            add(all, name, all->count - i % 2, rows[i / 2].surface, rows[i / 2].mode, err);
        if (!p) return false;
        if (rows[i / 2].change) rows[i / 2].change(p->scene);
        p->view = i % 2 ? WR_BENCH_RELIT : WR_BENCH_TURNS;
    }
    return true;
}

static bool fill_raised(WrBenchSections *all, WrError *err)
{
    static const char *const hows[] = { "first", "turning", "turning in the window" };
    static const WrBenchView views[] = { WR_BENCH_FIRST, WR_BENCH_TURNS, WR_BENCH_MOVES };
    for (int i = 0; i < 6; i++) {
        const char *surface = i < 3 ? "sphere" : "torus";
        char name[64];
        snprintf(name, sizeof name, "displaced %s, %s", surface, hows[i % 3]);
        WrBenchPicture *p = add(all, name, all->count - i % 3, surface, WR_BENCH_BUMP, err);
        if (!p) return false;
        raised(p->scene);
        p->view = views[i % 3];
    }
    return true;
}

static bool fill_still(WrBenchSections *all, WrError *err)
{
    static const WrBenchView views[] = { WR_BENCH_TURNS, WR_BENCH_RESTS, WR_BENCH_PAINTS };
    static const char *const names[] = { "turning", "at rest", "at rest, a dab each time" };
    return fill_views(all, views, names, 3, err) && fill_relit(all, err) && fill_raised(all, err);
}

static bool fill_first(WrBenchSections *all, WrError *err)
{
    static const WrBenchView views[] = { WR_BENCH_TURNS, WR_BENCH_FIRST };
    static const char *const names[] = { "the next frame", "the first frame" };
    return fill_views(all, views, names, 2, err);
}

static bool fill_output(WrBenchSections *all, WrError *err)
{
    static const char *const names[] = { [WR_BENCH_CODES] = "8-bit codes",
                                         [WR_BENCH_FLOATS] = "floats",
                                         [WR_BENCH_CONVERTED] = "floats, then 8-bit codes" };
    for (int m = 0; m < 2; m++)
        for (int k = 0; k < 3; k++) {
            char name[64];
            snprintf(name, sizeof name, "%s, %s", m ? "bump" : "smooth", names[k]);
            WrBenchPicture *p =
                add(all, name, 3 * m, "sphere", m ? WR_BENCH_BUMP : WR_BENCH_PHONG, err);
            if (!p) return false;
            p->out = (WrBenchOut)k;
        }
    return true;
}

const WrBenchSection wr_bench_section_table[] = {
    { "surfaces", "effects on each surface, relative to smooth shading", fill_surfaces },
    { "schemes", "how the table is looked up, beside central", fill_schemes },
    { "normals", "the formula of the normal, beside blinn", fill_normals },
    { "aliasing", "anti-aliasing methods, relative to one sample", fill_aliasing },
    { "effects", "each effect, beside the picture without it", fill_effects },
    { "isa", "the set of instructions, beside the plain text", fill_isa },
    { "plan", "the planned effects, relative to all effects", fill_plan },
    { "still", "a view at rest, beside one that turns", fill_still },
    { "first", "a new renderer's first frame, beside the next", fill_first },
    { "output", "floats, beside 8-bit codes", fill_output },
    { "simd", "loops written by hand, beside the stages that they replace", fill_simd },
    { .name = NULL },
};
