#include "render/environment/env_setup.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "image/image.h"
#include "render/frame/tile.h"
#include "render/plan/plan.h"
#include "scene/scene.h"
#include "shade/environment_blur.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* ---- env lookup ---- */

void wr_env_lookup_drop(WrEnvLookup *mirror)
{
    wr_environment_map_free(mirror->source);
    wr_free(mirror->rgba);
    *mirror = (WrEnvLookup){ 0 };
}

/* All that the blur depends on: equal settings keep the table, whatever the material's colour or strength is. */
static bool holds(const WrEnvLookup *mirror, const WrEnvironmentMap *map,
                  const WrEnvironmentBrdf *gloss, double fine)
{
    const WrEnvironmentBrdf *own = &mirror->gloss;
    if (mirror->source != map) return false;
    if (!gloss) return own->lobe == WR_LOBE_NONE;
    return own->lobe == gloss->lobe && own->alpha == gloss->alpha && own->power == gloss->power &&
           own->gated == gloss->gated && mirror->fine == fine;
}

/* Copies row j >= 0 of rgb into the padded table.
   The table has a border of one texel on every side; columns wrap, so bilinear fetches need no test. */
static void put_row(WrEnvLookup *mirror, int j, const float *rgb)
{
    const int w = mirror->width;
    float *out = mirror->rgba + (size_t)(j + 1) * (size_t)mirror->pitch * 4;
    for (int i = -1; i <= w; i++, out += 4)
        memcpy(out, rgb + (size_t)((i + w) % w) * 3, 3 * sizeof *out);
}

/* Fills the row above the first or below the last so that the pole is the mean of that row.
   2 mean - row: bilinear interpolation half-way, at the pole itself, is then the mean for every longitude
   (HC111). */
static void put_pole(WrEnvLookup *mirror, int from, int to)
{
    const int w = mirror->width;
    const size_t row = (size_t)mirror->pitch * 4;
    const float *in = mirror->rgba + (size_t)(from + 1) * row;
    float *out = mirror->rgba + (size_t)(to + 1) * row;
    for (int c = 0; c < 3; c++) {
        double mean = 0;
        for (int i = 1; i <= w; i++) mean += (double)in[4 * i + c] / w;
        for (int i = 0; i < mirror->pitch; i++)
            out[4 * i + c] = (float)(2 * mean - (double)in[4 * i + c]);
    }
}

static bool fill(WrEnvLookup *mirror, const float *rgb, WrError *err)
{
    mirror->pitch = mirror->width + 2;
    mirror->rgba = wr_try_alloc((size_t)mirror->pitch * (size_t)(mirror->height + 2),
                                4 * sizeof(float), "surroundings", err);
    if (!mirror->rgba) return false;
    for (int j = 0; j < mirror->height; j++)
        put_row(mirror, j, rgb + (size_t)j * (size_t)mirror->width * 3);
    put_pole(mirror, 0, -1);
    put_pole(mirror, mirror->height - 1, mirror->height);
    return true;
}

/* Blurred pictures are small: their width is `fine` texels over the lobe's width. */
static bool fill_blurred(WrEnvLookup *mirror, const WrEnvironmentBrdf *gloss, WrPool *pool,
                         WrError *err)
{
    mirror->width = wr_blur_width(gloss, mirror->fine);
    mirror->height = mirror->width / 2;
    float *rgb = wr_try_alloc((size_t)mirror->width * (size_t)mirror->height, 3 * sizeof *rgb,
                              "blurred surroundings", err);
    const bool good =
        rgb && wr_environment_map_blur(mirror->source, gloss, mirror->width, pool, rgb, err) &&
        fill(mirror, rgb, err);
    wr_free(rgb);
    return good;
}

bool wr_env_lookup_update(WrEnvLookup *mirror, const WrEnvironmentMap *map,
                          const WrEnvironmentBrdf *gloss, double fine, WrPool *pool, WrError *err)
{
    if (holds(mirror, map, gloss, fine)) return true;
    wr_env_lookup_drop(mirror);
    mirror->source = wr_environment_map_share(map);
    mirror->fine = fine;
    if (gloss) mirror->gloss = *gloss;
    mirror->width = map->image->width, mirror->height = map->image->height;
    if (gloss ? fill_blurred(mirror, gloss, pool, err) : fill(mirror, map->image->data, err))
        return true;
    wr_env_lookup_drop(mirror);
    return false;
}

/* ---- env prefilter ---- */

void wr_env_prefilter_drop_rungs(WrEnvPrefilter *grades)
{
    for (int i = 0; i < WR_SVBRDF_RUNGS; i++) wr_env_lookup_drop(&grades->rung[i]);
}

void wr_env_prefilter_drop(WrEnvPrefilter *grades)
{
    wr_env_prefilter_drop_rungs(grades);
    grades->there = false;
}

/* Roughness and metalness are not compared: the tables cover all values of both. */
static bool same(const WrReflectance *a, const WrReflectance *b)
{
    return a->model == b->model && a->energy == b->energy && a->shininess == b->shininess &&
           a->ior == b->ior;
}

static void update_shares(WrEnvPrefilter *grades, const WrMaterial *m)
{
    const WrReflectance of = wr_scene_reflectance(m);
    if (grades->there && same(&grades->of, &of) && grades->ks == m->specular &&
        grades->tint == m->tint && grades->gated == m->gate)
        return;
    grades->of = of, grades->ks = m->specular, grades->tint = m->tint, grades->gated = m->gate;
    grades->there = true;
    wr_svbrdf_init(&grades->vary, &of, m->specular, m->tint, m->gate);
}

/* Range of blur levels that the material's widths need.
   Rung i has alpha = 2^-i, the last one none (a mirror); fetches interpolate between two rungs, and widening
   by slopes moves towards rung 0. */
static void rungs_of(const WrEnvironmentBrdf *gloss, const WrPlan *plan, int *first, int *last)
{
    const double rung = -wr_log2(gloss->alpha), most = WR_SVBRDF_RUNGS - 1;
    *first = 0, *last = (int)most;
    if (wr_plan_runs(plan, WR_EFFECT_VARIED)) return;
    *last = (int)fmin(ceil(rung) + 1, most);
    if (!wr_plan_runs(plan, WR_EFFECT_SPREAD)) *first = (int)fmin(fmax(floor(rung), 0), most - 1);
}

bool wr_env_prefilter_update(WrEnvPrefilter *grades, const WrScene *scene, const WrPlan *plan,
                             WrPool *pool, WrError *err)
{
    WrEnvironmentBrdf gloss, lobe;
    int first, last;
    update_shares(grades, &scene->material);
    if (!plan->graded) return true;
    wr_scene_gloss(&scene->material, &gloss);
    rungs_of(&gloss, plan, &first, &last);
    for (int i = first; i <= last; i++) {
        const bool blurred = i + 1 < WR_SVBRDF_RUNGS;
        wr_svbrdf_rung(&gloss, i, &lobe);
        if (!wr_env_lookup_update(&grades->rung[i], scene->environment.light,
                                  blurred ? &lobe : NULL, plan->gloss, pool, err))
            return false;
    }
    return true;
}

/* Copies the terms of one roughness step and pads them with 0.
   Padding to a multiple of four: kernels load four coefficients at once (vary_parts). */
static void put_terms(const double *terms, double *to, float *single)
{
    for (int k = 0; k < WR_SVBRDF_TERMS; k++)
        to[k] = k < WR_ALBEDO_TERMS ? terms[k] : 0, single[k] = (float)to[k];
}

static void put_step(const WrSvbrdf *vary, int i, WrKernVaryd *wide, WrKernVary *single)
{
    wide->mean[i] = vary->mean[i], single->mean[i] = (float)vary->mean[i];
    wide->again[i] = vary->again[i], single->again[i] = (float)vary->again[i];
    put_terms(vary->albedo[i], wide->albedo[i], single->albedo[i]);
    put_terms(vary->matt[i], wide->matt[i], single->matt[i]);
    put_terms(vary->twice[i], wide->twice[i], single->twice[i]);
}

/* Reflected shares at step i: for non-metal and metal, or for one fixed metalness.
   own and white are linear in metalness, so a fixed metalness is mixed here once. */
static void put_shares(const WrSvbrdf *vary, bool alike, double metal, int i, WrKernVaryd *wide,
                       WrKernVary *single)
{
    double own[2][WR_ALBEDO_TERMS], white[2][WR_ALBEDO_TERMS];
    for (int k = 0; k < 2 * WR_ALBEDO_TERMS; k++) {
        const int at = k / WR_ALBEDO_TERMS, term = k % WR_ALBEDO_TERMS;
        const double to = alike ? metal : at;
        const double o = vary->own[0][i][term], w = vary->white[0][i][term];
        own[at][term] = o + to * (vary->own[1][i][term] - o);
        white[at][term] = w + to * (vary->white[1][i][term] - w);
    }
    for (int at = 0; at < 2; at++) {
        put_terms(own[at], wide->own[at][i], single->own[at][i]);
        put_terms(white[at], wide->white[at][i], single->white[at][i]);
    }
}

/* alike: without a picture of metalness one row of each table is enough. rung[i].rgba points past the border,
   to texel (0, 0). */
void wr_env_prefilter_fill(const WrEnvPrefilter *grades, const WrScene *scene, WrTileJob *job)
{
    const WrSvbrdf *vary = &grades->vary;
    const WrMaterial *m = &scene->material;
    WrKernVaryd *wide = &job->vary_double;
    WrKernVary *single = &job->vary;
    WrEnvironmentBrdf gloss;
    wr_scene_gloss(m, &gloss);
    job->rough = sqrt(gloss.alpha);
    wide->metals = single->metals = wr_reflects[m->model].metalness;
    wide->again_twice = single->again_twice =
        wr_reflect_again(&wr_reflects[m->model], m->energy == WR_ENERGY_KEPT);
    wide->alike = single->alike = !job->facets[WR_FACET_METALNESS].near.rgba;
    for (int i = 0; i < WR_SVBRDF_STEPS; i++) {
        put_step(vary, i, wide, single);
        put_shares(vary, wide->alike, fmin(fmax(m->metalness, 0), 1), i, wide, single);
    }
    for (int i = 0; i < WR_SVBRDF_RUNGS; i++) {
        const WrEnvLookup *of = &grades->rung[i];
        const WrKernMipLevel rung = { of->rgba ? of->rgba + 4 * ((ptrdiff_t)of->pitch + 1) : NULL,
                                      of->pitch, of->width, of->height };
        wide->rung[i] = single->rung[i] = rung;
    }
}

/* out = a b, row-major 3 x 3. */
static void product(const double a[9], const double b[9], double out[9])
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            out[3 * r + c] = a[3 * r] * b[c] + a[3 * r + 1] * b[3 + c] + a[3 * r + 2] * b[6 + c];
}

static void narrow(const double *from, float *to, int count)
{
    for (int i = 0; i < count; i++) to[i] = (float)from[i];
}

static void narrow_all(const WrKernSurroundd *from, WrKernSurround *to)
{
    narrow(from->form[0], to->form[0], 3 * WR_FORM_TERMS);
    narrow(from->colour, to->colour, 3);
    narrow(from->matt, to->matt, WR_ALBEDO_TERMS);
    narrow(from->again, to->again, WR_ALBEDO_TERMS);
    to->kd = (float)from->kd, to->mean = (float)from->mean;
}

/* Parameters of the mirrored fetch and its reflectance.
   even: the one colour of an even environment, for which no table is read. */
static void fill_mirror(const WrEnvironment *from, const WrEnvironmentBrdf *gloss,
                        const double axes[9], const WrEnvLookup *mirror, WrKernMirrord *out)
{
    memcpy(out->axes, axes, sizeof out->axes);
    memcpy(out->own, gloss->own, sizeof out->own);
    memcpy(out->white, gloss->white, sizeof out->white);
    out->strength = from->strength;
    out->width = mirror->width, out->height = mirror->height, out->pitch = mirror->pitch;
    if (mirror->rgba) out->rgba = mirror->rgba + 4 * ((ptrdiff_t)mirror->pitch + 1);
    for (int c = 0; c < 3; c++) out->even[c] = (double)from->light->image->data[c];
}

static void narrow_mirror(const WrKernMirrord *from, WrKernMirror *to)
{
    narrow(from->axes, to->axes, 9);
    narrow(from->own, to->own, WR_ALBEDO_TERMS);
    narrow(from->white, to->white, WR_ALBEDO_TERMS);
    narrow(from->even, to->even, 3);
    to->strength = (float)from->strength;
    to->rgba = from->rgba, to->pitch = from->pitch;
    to->width = from->width, to->height = from->height;
}

/* axes = turn * rotation: from object space to the unturned picture, so fetches use directions in object
   space. Everything is computed in double and then narrowed. */
void wr_environment_map_look(const WrScene *scene, const WrPlan *plan, const double rotation[9],
                             const WrEnvLookup *mirror, WrEnvironmentMapLook *out)
{
    const WrEnvironment *from = &scene->environment;
    const WrMaterial *m = &scene->material;
    WrKernSurroundd *wide = &out->wide;
    WrEnvironmentBrdf gloss;
    double turn[9], axes[9];
    *out = (WrEnvironmentMapLook){ 0 };
    wr_scene_gloss(m, &gloss);
    wr_environment_map_turn(from->turn_deg, turn);
    product(turn, rotation, axes);
    wr_environment_map_form(from->light, axes, from->strength, plan->harmonics, wide->form);
    wide->kd = wr_plan_runs(plan, WR_EFFECT_SURROUND) ? m->diffuse : 0;
    wide->colour[0] = m->colour.x, wide->colour[1] = m->colour.y, wide->colour[2] = m->colour.z;
    wide->mean = gloss.mean;
    memcpy(wide->matt, gloss.matt, sizeof wide->matt);
    memcpy(wide->again, gloss.again, sizeof wide->again);
    const bool twice = wr_reflect_again(&wr_reflects[m->model], m->energy == WR_ENERGY_KEPT);
    out->shares = gloss.plain ? 0 : twice ? 2 : 1;
    narrow_all(wide, &out->single);
    fill_mirror(from, &gloss, axes, mirror, &out->mirror_wide);
    narrow_mirror(&out->mirror_wide, &out->mirror);
}
