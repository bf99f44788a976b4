/* Benchmark sections: measurement of their pictures, beside the machine's peaks, and the results as tables and as JSON. */
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "bench/bench.h"
#include "bench/sections.h"
#include "cli/cli.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "system/clock.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* ---- memory traffic and arithmetic ---- */

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

static void print_peaks(const WrBenchSections *all, WrText *text)
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

static void print_section(const WrBenchSections *all, WrText *text)
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

static void head_json(const WrBenchSections *all, WrText *text)
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

static void section_json(const WrBenchSections *all, WrText *text)
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
                                     .moving = p->view == WR_BENCH_MOVES,
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

static void clear(WrBenchSections *all)
{
    for (int i = 0; i < all->count; i++) wr_scene_free(all->picture[i].scene);
    all->count = 0;
}

static bool measure(WrBenchSections *all, const WrBenchSection *section, WrError *err)
{
    all->section = section;
    clear(all);
    if (!section->fill(all, err)) return false;
    Lane *lanes = wr_alloc((size_t)all->count, sizeof *lanes);
    bool good = true;
    for (int i = 0; i < all->count && good; i++) good = lane_init(all, i, lanes, err);
    for (int round = -1; round < all->rounds && good; round++) /* the first round fills caches */
        for (int i = 0; i < all->count && good; i++) {
            good = draw(all, &all->picture[i], &lanes[i], round, err);
            if (good && wr_cancel_requested(all->cli->cancel)) good = wr_fail(err, "interrupted");
        }
    for (int i = 0; i < all->count; i++) {
        if (good) all->picture[i].ms = wr_bench_median(lanes[i].ms, all->rounds); /* sorts them */
        if (good) all->picture[i].least_ms = lanes[i].ms[0];
        lane_fini(&lanes[i]);
    }
    wr_free(lanes);
    return good;
}

/* ---- the requested sections ---- */

bool wr_bench_sections(const WrCli *cli, uint64_t chosen, bool quick, bool exact, WrText *text,
                       WrError *err)
{
    WrBenchSections *all = wr_alloc(1, sizeof *all);
    all->cli = cli;
    all->width = cli->width;
    all->height = cli->height;
    all->rounds = quick ? 5 : 15;
    all->fast = !exact;
    bool good = wr_peaks_measure(cli->pool, quick, cli->cancel, &all->peaks, err);
    bool any = false;
    if (good && cli->json) head_json(all, text);
    else if (good) print_peaks(all, text);
    for (int i = 0; wr_bench_section_table[i].name && good; i++) {
        if (!(chosen >> i & 1)) continue;
        good = measure(all, &wr_bench_section_table[i], err);
        if (good && cli->json) wr_text_add(text, any ? ",\n" : ",\n\"sections\": [\n");
        if (good && cli->json) section_json(all, text);
        else if (good) print_section(all, text);
        any = true;
        clear(all);
    }
    if (cli->json && any) wr_text_add(text, "]");
    wr_free(all);
    return good;
}
