/* The table of sections and their pictures. */
#include "cli/bench_sections.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/bench.h"
#include "cli/bench_materials.h"
#include "cli/cli.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "render/kernels/kern.h"
#include "scene/dials.h"
#include "scene/scene.h"
#include "system/clock.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* ---- bench section count ---- */

/* Count of memory traffic and arithmetic of a picture, for comparison with the machine's peaks.

   Operations are those in the kernels' source (render/kern_*_body.h, shade/light_body.h, base/kernmath.h) for one
   sample: + - * / and square roots in floating point count as one each. Comparisons, selections, roundings, integers,
   per-row constants and missed rays are not counted. A build may do more (a square root by estimate and a step) or
   fewer (zeros left out). Only the stages of a sphere under one directional light and a perspective camera with one
   sample per pixel are counted; other pictures have no count. */

enum {
    HIT = 13 + 33,               /* the ray; foot of the perpendicular, root, point */
    NORMAL = 13,                 /* n = P/|P|, P on the sphere */
    PARAMETERS = 20 + 27,        /* u; v: an arc tangent each */
    TANGENTS = 26,               /* Pu, Pv, |N| */
    LOOK = 11 + 18 + 4,          /* texel position; two slopes, bilinear; their scales */
    SIDE = 14,                   /* flip towards the viewer */
    BLINN = 3 + 18 + 7 + 13,     /* the slopes; D; N + D; normalisation */
    DIFFUSE = 5 + 6 + 6,         /* n'.l; its sums, and those of light and colour */
    SPECULAR = 13 + 28 + 36 + 3, /* v; h and n'.h; the power; its sums */
    CODES = 12                   /* three channels */
};

static bool spared(const WrPlan *plan)
{
    static const WrEffect others[] = { WR_EFFECT_COLOUR,  WR_EFFECT_WIDE,    WR_EFFECT_INVARIANT,
                                       WR_EFFECT_EXACT,   WR_EFFECT_SAMPLES, WR_EFFECT_CURVATURE,
                                       WR_EFFECT_BOUND,   WR_EFFECT_FILTER,  WR_EFFECT_BACK,
                                       WR_EFFECT_ROUNDED, WR_EFFECT_DOUBLE,  WR_EFFECT_HALF,
                                       WR_EFFECT_TINT,    WR_EFFECT_NORMALS, WR_EFFECT_GRAIN };
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (wr_plan_runs(plan, others[i])) return false;
    return plan->sampling == WR_SAMPLING_ONE;
}

/* True if all stages of the picture, except the texel fetch, are in the count. */
static bool counted(const WrBenchPicture *p, const WrPlan *plan)
{
    const WrScene *scene = p->scene;
    return scene->shape.kind == WR_SURFACE_sphere && scene->light_count == 1 &&
           scene->lights[0].kind == WR_LIGHT_DIRECTIONAL && !scene->camera.orthographic &&
           p->view == WR_BENCH_TURNS && p->out != WR_BENCH_CONVERTED && spared(plan) &&
           wr_plan_runs(plan, WR_EFFECT_DIFFUSE) && wr_plan_runs(plan, WR_EFFECT_SPECULAR);
}

static double flops_of(const WrBenchPicture *p, const WrPlan *plan)
{
    if (!counted(p, plan)) return 0;
    double flops = HIT + NORMAL + SIDE + DIFFUSE + SPECULAR;
    if (p->out == WR_BENCH_CODES) flops += CODES;
    if (wr_plan_runs(plan, WR_EFFECT_PARAMETERS)) flops += PARAMETERS;
    if (wr_plan_runs(plan, WR_EFFECT_TANGENTS)) flops += TANGENTS;
    if (!wr_plan_runs(plan, WR_EFFECT_BUMP)) return flops;
    return plan->scheme == WR_SCHEME_CENTRAL ? flops + LOOK + BLINN : 0;
}

/* Least memory traffic of a picture: its own bytes, written once, and the fetched ones: the whole table, or four
   texels per sample if these are fewer. */
static double bytes_of(const WrBenchSections *all, const WrBenchPicture *p, const WrFrame *frame)
{
    static const double own[] = {
        [WR_BENCH_CODES] = 4, [WR_BENCH_FLOATS] = 16, [WR_BENCH_CONVERTED] = 16 + 16 + 3
    };
    const double samples = (double)frame->shaded;
    if (p->view == WR_BENCH_RESTS || p->view == WR_BENCH_PAINTS || p->view == WR_BENCH_RELIT)
        return 0;
    double bytes = (double)all->width * all->height * own[p->out];
    if (wr_plan_runs(frame->plan, WR_EFFECT_BUMP))
        bytes += 4 * fmin((double)p->table * p->table, 4 * samples);
    const WrImage *colour = p->scene->colour;
    if (colour && wr_plan_runs(frame->plan, WR_EFFECT_COLOUR))
        bytes += 16 * fmin((double)colour->width * colour->height, 4 * samples);
    return bytes;
}

/* Count the memory traffic and operations of a picture: bytes and flops, 0 if not counted. */
static void bench_picture_count(const WrBenchSections *all, WrBenchPicture *picture,
                                const WrFrame *frame)
{
    picture->bytes = bytes_of(all, picture, frame);
    picture->flops = flops_of(picture, frame->plan);
}

/* ---- Sections and peaks as tables and as JSON ---- */

/* Rates of a picture besides its time; NAN: none. */
typedef struct Rates {
    double ratio, ns, gbytes, gflops;
} Rates;

static double over(double a, double b)
{
    return a > 0 && b > 0 ? a / b : NAN;
}

static Rates rates_of(const WrBenchSections *all, const WrBenchPicture *p)
{
    return (Rates){ .ratio = over(p->ms, all->picture[p->base].ms),
                    .ns = over(1e6 * p->ms, (double)p->samples),
                    .gbytes = over(1e-6 * p->bytes, p->ms),
                    .gflops = over(1e-6 * p->flops * (double)p->samples, p->ms) };
}

static int threads_of(const WrBenchSections *all)
{
    return wr_pool_threads(all->cli->pool);
}

void wr_bench_peaks_print(const WrBenchSections *all, WrText *text)
{
    wr_text_addf(text, "picture %dx%d, %s arithmetic, threads %d, medians of %d rounds by turns\n",
                 all->width, all->height, all->fast ? "fast" : "exact", threads_of(all),
                 all->rounds);
    wr_text_add(text, "this machine at its best:");
    for (int b = 0; b < WR_PEAK_BUILDS; b++)
        if (all->peaks.gflops[b] > 0)
            wr_text_addf(text, " %s %.1f", wr_peak_builds[b], all->peaks.gflops[b]);
    wr_text_add(text, " GFLOP/s; copying");
    for (int k = 0; k < WR_PEAK_LEVELS; k++)
        wr_text_addf(text, " %s %.1f", wr_peak_levels[k], all->peaks.gbytes[k]);
    wr_text_add(text, " GB/s\n");
}

static void add_rate(WrText *text, int width, int digits, double x)
{
    if (isnan(x)) wr_text_addf(text, " %*s", width, "-");
    else wr_text_addf(text, " %*.*f", width, digits, x);
}

void wr_bench_section_print(const WrBenchSections *all, WrText *text)
{
    wr_text_addf(text, "\n%s: %s\n%-38s %9s %9s %7s %10s %7s %8s\n", all->section->name,
                 all->section->varies, "", "ms", "least", "ratio", "ns/sample", "GB/s", "GFLOP/s");
    for (int i = 0; i < all->count; i++) {
        const WrBenchPicture *p = &all->picture[i];
        const Rates r = rates_of(all, p);
        wr_text_addf(text, "  %-36s %9.3f %9.3f", p->name, p->ms, p->least_ms);
        add_rate(text, 7, 2, r.ratio);
        add_rate(text, 10, 2, r.ns);
        add_rate(text, 7, 2, r.gbytes);
        add_rate(text, 8, 2, r.gflops);
        wr_text_add(text, "\n");
    }
}

static void member(WrText *text, const char *name, double x)
{
    wr_text_addf(text, ", \"%s\": ", name);
    wr_text_add_json_number(text, x);
}

static void string_member(WrText *text, const char *name, const char *value)
{
    wr_text_addf(text, ", \"%s\": ", name);
    wr_text_add_json_string(text, value);
}

void wr_bench_head_json(const WrBenchSections *all, WrText *text)
{
    wr_text_addf(text, "\"width\": %d, \"height\": %d, \"threads\": %d, \"rounds\": %d", all->width,
                 all->height, threads_of(all), all->rounds);
    string_member(text, "isa", all->cli->isa ? all->cli->isa : "auto");
    string_member(text, "arithmetic", all->fast ? "fast" : "exact");
    wr_text_add(text, ",\n\"peaks\": {\"sums\": [");
    const char *comma = "";
    for (int b = 0; b < WR_PEAK_BUILDS; b++) {
        if (!(all->peaks.gflops[b] > 0)) continue;
        wr_text_addf(text, "%s{\"isa\": \"%s\"", comma, wr_peak_builds[b]);
        member(text, "gflops", all->peaks.gflops[b]);
        wr_text_add(text, "}");
        comma = ", ";
    }
    wr_text_add(text, "], \"copies\": [");
    for (int k = 0; k < WR_PEAK_LEVELS; k++) {
        wr_text_addf(text, "%s{\"level\": \"%s\"", k > 0 ? ", " : "", wr_peak_levels[k]);
        member(text, "bytes", all->peaks.bytes[k]);
        member(text, "gbytes", all->peaks.gbytes[k]);
        wr_text_add(text, "}");
    }
    wr_text_add(text, "]}");
}

static void row_json(const WrBenchSections *all, const WrBenchPicture *p, WrText *text)
{
    const Rates r = rates_of(all, p);
    wr_text_add(text, "  {\"name\": ");
    wr_text_add_json_string(text, p->name);
    string_member(text, "base", all->picture[p->base].name);
    member(text, "table", p->table);
    member(text, "ms", p->ms);
    member(text, "least_ms", p->least_ms);
    member(text, "ratio", r.ratio);
    member(text, "samples", (double)p->samples);
    member(text, "ns_per_sample", r.ns);
    member(text, "bytes", p->bytes > 0 ? p->bytes : NAN);
    member(text, "gbytes", r.gbytes);
    member(text, "flops_per_sample", p->flops > 0 ? p->flops : NAN);
    member(text, "gflops", r.gflops);
    if (p->effect >= 0) {
        string_member(text, "effect", wr_effects[p->effect].rule);
        wr_text_addf(text, ", \"ran\": %s", p->ran ? "true" : "false");
    }
    wr_text_add(text, "}");
}

void wr_bench_section_json(const WrBenchSections *all, WrText *text)
{
    wr_text_addf(text, "{\"name\": \"%s\"", all->section->name);
    string_member(text, "varies", all->section->varies);
    wr_text_add(text, ", \"rows\": [\n");
    for (int i = 0; i < all->count; i++) {
        row_json(all, &all->picture[i], text);
        wr_text_add(text, i + 1 < all->count ? ",\n" : "]}");
    }
}

void wr_bench_lines_json(const char *lines, WrText *text)
{
    char word[6][32];
    const char *comma = "", *end;
    wr_text_add(text, "[");
    for (const char *line = lines; (end = strchr(line, '\n')); line = end + 1) {
        if (sscanf(line, "%31s %31s %31s %31s %31s %31s", word[0], word[1], word[2], word[3],
                   word[4], word[5]) != 6)
            continue;
        wr_text_addf(text,
                     "%s\n  {\"what\": \"%s\", \"of\": \"%s\", \"how\": \"%s\", \"table\": %s, "
                     "\"threads\": %s, \"ms\": %s}",
                     comma, word[0], word[1], word[2], word[3], word[4], word[5]);
        comma = ",";
    }
    wr_text_add(text, "]");
}

/* ---- Measurement of a section's pictures, alternating between them ---- */

#define DAB 64 /* texels along each side */

typedef struct Lane {
    WrRenderer *renderer;
    WrField *field;
    uint8_t *bytes; /* output of the float conversion */
    double *ms;     /* [rounds] */
} Lane;

static const char *isa_of(const WrBenchSections *all, const WrBenchPicture *p)
{
    return p->isa ? p->isa : all->cli->isa;
}

static WrField *field_of(const WrBenchSections *all, const Lane *lanes, int index, WrError *err)
{
    for (int i = 0; i < index; i++)
        if (all->picture[i].table == all->picture[index].table)
            return wr_field_share(lanes[i].field);
    return wr_bench_field(all->picture[index].table, err);
}

static bool lane_init(const WrBenchSections *all, int index, Lane *lanes, WrError *err)
{
    const WrBenchPicture *p = &all->picture[index];
    Lane *lane = &lanes[index];
    lane->ms = wr_alloc((size_t)all->rounds, sizeof *lane->ms);
    lane->field = field_of(all, lanes, index, err);
    if (!lane->field) return false;
    if (p->out == WR_BENCH_CONVERTED) {
        lane->bytes =
            wr_try_alloc((size_t)all->width * (size_t)all->height, 4, "a picture's codes", err);
        if (!lane->bytes) return false;
    }
    lane->renderer = wr_renderer_new(all->cli->pool, isa_of(all, p), err);
    return lane->renderer;
}

static void lane_fini(Lane *lane)
{
    wr_renderer_free(lane->renderer);
    wr_field_free(lane->field);
    wr_free(lane->bytes);
    wr_free(lane->ms);
}

/* A square dab in the middle of the table, which is the middle of the view; it changes every slope in it. */
static void paint(WrField *field, int size, int round)
{
    const int side = size < DAB ? size : DAB, from = (size - side) / 2;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++)
            wr_field_set(field, from + i, from + j,
                         1e-5f * (float)((7 * i + 13 * j + 5 * round) % 17));
}

/* The picture's scene; in sections with changing material, another material in each round. The caller frees it. */
static WrScene *scene_of_round(const WrBenchPicture *p, int round)
{
    if (p->view != WR_BENCH_RELIT) return wr_scene_share(p->scene);
    WrScene *scene = wr_scene_clone(p->scene);
    scene->material.diffuse *= round % 2 ? 0.9 : 0.95;
    return scene;
}

static bool draw(const WrBenchSections *all, WrBenchPicture *p, Lane *lane, int round, WrError *err)
{
    static const WrFrameCodes black = { 0 };
    const bool rests =
        p->view == WR_BENCH_RESTS || p->view == WR_BENCH_PAINTS || p->view == WR_BENCH_RELIT;
    WrScene *scene = scene_of_round(p, round);
    const WrFrameRequest request = { .field = lane->field,
                                     .scene = scene,
                                     .width = all->width,
                                     .height = all->height,
                                     .turn_deg = rests ? 0 : 7.3 * round,
                                     .keep = rests,
                                     .force = p->force,
                                     .full = p->full,
                                     .staged = p->staged,
                                     .codes = { .wanted = p->out == WR_BENCH_CODES } };
    WrFrame frame;
    if (p->view == WR_BENCH_PAINTS) paint(lane->field, p->table, round);
    if (p->view == WR_BENCH_FIRST) wr_renderer_free(lane->renderer), lane->renderer = NULL;
    const double start = wr_clock_seconds();
    if (!lane->renderer) lane->renderer = wr_renderer_new(all->cli->pool, isa_of(all, p), err);
    const bool drawn = lane->renderer && wr_renderer_frame(lane->renderer, &request, &frame, err);
    wr_scene_free(scene);
    if (!drawn) return false;
    if (lane->bytes) wr_frame_to_srgb8(&frame, &black, false, lane->bytes, all->cli->pool);
    if (round >= 0) lane->ms[round] = 1e3 * (wr_clock_seconds() - start);
    p->samples = frame.shaded;
    bench_picture_count(all, p, &frame);
    p->ran = p->effect >= 0 && frame.plan->rows[p->effect].ran;
    return true;
}

bool wr_bench_section_measure(WrBenchSections *all, const WrBenchSection *section, WrError *err)
{
    all->section = section;
    wr_bench_section_clear(all);
    if (!section->fill(all, err)) return false;
    Lane *lanes = wr_alloc((size_t)all->count, sizeof *lanes);
    bool good = true;
    for (int i = 0; i < all->count && good; i++) good = lane_init(all, i, lanes, err);
    for (int round = -1; round < all->rounds && good; round++) /* the first round fills caches */
        for (int i = 0; i < all->count && good; i++) {
            good = draw(all, &all->picture[i], &lanes[i], round, err);
            if (good && wr_cancel_asked(all->cli->cancel)) good = wr_fail(err, "interrupted");
        }
    for (int i = 0; i < all->count; i++) {
        if (good) all->picture[i].ms = wr_bench_median(lanes[i].ms, all->rounds); /* sorts them */
        if (good) all->picture[i].least_ms = lanes[i].ms[0];
        lane_fini(&lanes[i]);
    }
    wr_free(lanes);
    return good;
}

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
    [WR_ROW(WR_EFFECT_MODEL)] = { BUMPED, .with = wr_bench_facets, .without = same },
    [WR_ROW(WR_EFFECT_KEPT)] = { BUMPED, .with = wr_bench_metal, .forced = true },
    [WR_ROW(WR_EFFECT_SURROUND)] = { BUMPED, .with = wr_bench_under_sky, .without = same },
    [WR_ROW(WR_EFFECT_HARMONICS)] = { BUMPED, .with = wr_bench_under_sky },
    [WR_ROW(WR_EFFECT_MIRROR)] = { BUMPED, .with = wr_bench_under_sky },
    [WR_ROW(WR_EFFECT_BLUR)] = { BUMPED, .with = wr_bench_under_sky },
    [WR_ROW(WR_EFFECT_COLOUR)] = { .surface = "sphere", .mode = WR_BENCH_TEXTURE, .with = same },
    [WR_ROW(WR_EFFECT_TINT)] = { .surface = "sphere", .mode = WR_BENCH_TEXTURE, .with = filtered },
    [WR_ROW(WR_EFFECT_FACETS)] = { BUMPED, .with = wr_bench_worn, .without = wr_bench_facets },
    [WR_ROW(WR_EFFECT_VARIED)] = { BUMPED, .with = wr_bench_rough, .without = wr_bench_facets },
    [WR_ROW(WR_EFFECT_EMBOSSED)] = { BUMPED, .with = wr_bench_embossed, .without = same },
    [WR_ROW(WR_EFFECT_GRAIN)] = { BUMPED, .with = wr_bench_wooden, .without = same },
    [WR_ROW(WR_EFFECT_OCTAVES)] = { BUMPED, .with = wr_bench_wooden },
    [WR_ROW(WR_EFFECT_FADED)] = { BUMPED, .with = wr_bench_wooden_filtered },
    [WR_ROW(WR_EFFECT_NORMALS)] = { BUMPED, .with = wr_bench_mapped },
    [WR_ROW(WR_EFFECT_DISPLACED)] = { BUMPED, .with = wr_bench_displaced, .without = exact,
                                      .forced = true },
    [WR_ROW(WR_EFFECT_PARALLAX)] = { BUMPED, .with = wr_bench_parallax, .without = same,
                                     .forced = true },
    [WR_ROW(WR_EFFECT_BUMP)] = { BUMPED, .with = same },
    [WR_ROW(WR_EFFECT_GRADIENT)] = { BUMPED, .with = same, .without = bilinear },
    [WR_ROW(WR_EFFECT_WIDE)] = { BUMPED, .with = far_replicated },
    [WR_ROW(WR_EFFECT_INVARIANT)] = { BUMPED, .with = invariant },
    [WR_ROW(WR_EFFECT_EXACT)] = { BUMPED, .with = exact },
    [WR_ROW(WR_EFFECT_CURVATURE)] = { BUMPED, .with = exact, .without = same },
    [WR_ROW(WR_EFFECT_SHADOW)] = { BUMPED, .with = shadowed, .without = same },
    [WR_ROW(WR_EFFECT_CAST)] = { .surface = "torus",
                                 .mode = WR_BENCH_BUMP,
                                 .with = wr_bench_objects_hide,
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
    [WR_ROW(WR_EFFECT_FACED)] = { BUMPED, .with = wr_bench_facets, .forced = true },
    [WR_ROW(WR_EFFECT_FAINT)] = { BUMPED, .with = wr_bench_faint, .forced = true },
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
                 { "three tori", "torus", WR_BENCH_BUMP, wr_bench_three_objects },
                 { "torus, moments", "torus", WR_BENCH_BUMP, moments },
                 { "torus, relief shadow", "torus", WR_BENCH_BUMP, shadowed },
                 { "three tori, shadows", "torus", WR_BENCH_BUMP, wr_bench_three_shadowed },
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

static bool fill_still(WrBenchSections *all, WrError *err)
{
    static const WrBenchView views[] = { WR_BENCH_TURNS, WR_BENCH_RESTS, WR_BENCH_PAINTS };
    static const char *const names[] = { "turning", "at rest", "at rest, a dab each time" };
    return fill_views(all, views, names, 3, err) && fill_relit(all, err);
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

const WrBenchSection wr_bench_sections[] = {
    { "surfaces", "what is shown on which surface, beside smooth shading", fill_surfaces },
    { "schemes", "how the table is looked up, beside central", fill_schemes },
    { "normals", "the formula of the normal, beside blinn", fill_normals },
    { "aliasing", "what is done against aliasing, beside one sample", fill_aliasing },
    { "effects", "each effect, beside the picture without it", fill_effects },
    { "isa", "the set of instructions, beside the plain text", fill_isa },
    { "plan", "only what the picture needs, beside all that it could leave out", fill_plan },
    { "still", "a view at rest, beside one that turns", fill_still },
    { "first", "a new renderer's first frame, beside the next", fill_first },
    { "output", "floats, beside 8-bit codes", fill_output },
    { "simd", "loops written by hand, beside the stages that they replace", fill_simd },
    { .name = NULL },
};

int wr_bench_section_find(const char *name)
{
    for (int i = 0; wr_bench_sections[i].name; i++)
        if (strcmp(wr_bench_sections[i].name, name) == 0) return i;
    return -1;
}

void wr_bench_section_clear(WrBenchSections *all)
{
    for (int i = 0; i < all->count; i++) wr_scene_free(all->picture[i].scene);
    all->count = 0;
}
