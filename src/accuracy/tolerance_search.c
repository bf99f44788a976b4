/* Choice under a tolerance: blocks get finer levels until it is met.
   The picture is cut in blocks of WR_FRAME_BLOCK pixels. An option of a block is a pair (scheme, normal
   formula) and a level: 2^level samples a side. `squares` is the sum of squared differences over a block's
   pixels and three channels, so rms^2 of the picture is the sum over blocks / (3 pixels). */
#include "accuracy/tolerance_search.h"

#include "accuracy/tolerance_internal.h"
#include "base/cpu.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "scene/objects.h"
#include "system/clock.h"
#include "system/path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- price ---- */

/* Price of samples by counted work, not time: so the same picture gets the same dials on any machine at any
   time.
   A choice by measured times would differ between two runs; a picture must be repeatable from its text. */

/* Nanoseconds of one sample on one thread, by regression over all surfaces, slopes and normals at 512 x 512.
   Only the ratios matter. */
WR_ROWS(surface_price);
static const double surface_price[] = {
    [WR_ROW(WR_SURFACE_plane)] = 10.5,        [WR_ROW(WR_SURFACE_bent)] = 28,
    [WR_ROW(WR_SURFACE_curl)] = 40,           [WR_ROW(WR_SURFACE_bezier)] = 48,
    [WR_ROW(WR_SURFACE_sphere)] = 15,         [WR_ROW(WR_SURFACE_cylinder)] = 14,
    [WR_ROW(WR_SURFACE_cone)] = 21,           [WR_ROW(WR_SURFACE_torus)] = 40,
    [WR_ROW(WR_SURFACE_cube)] = 18,           [WR_ROW(WR_SURFACE_ribbon)] = 43,
    [WR_ROW(WR_SURFACE_disc)] = 32,           [WR_ROW(WR_SURFACE_capsule)] = 42,
    [WR_ROW(WR_SURFACE_superellipsoid)] = 90, [WR_ROW(WR_SURFACE_revolution)] = 60,
    [WR_ROW(WR_SURFACE_formula)] = 200,       [WR_ROW(WR_SURFACE_mesh)] = 30,
    [WR_ROW(WR_SURFACE_patches)] = 60,        [WR_ROW(WR_SURFACE_terrain)] = 60,
};
WR_ROWS_END(surface_price, WR_SURFACE_COUNT);

WR_ROWS(slope_price);
static const double slope_price[] = {
    [WR_ROW(WR_SCHEME_NEAREST)] = 4.5,      [WR_ROW(WR_SCHEME_BILINEAR)] = 4.2,
    [WR_ROW(WR_SCHEME_CENTRAL)] = 7.5,      [WR_ROW(WR_SCHEME_BSPLINE)] = 15.0,
    [WR_ROW(WR_SCHEME_BSPLINE_FIT)] = 15.0, [WR_ROW(WR_SCHEME_CATMULL)] = 17.0,
};
WR_ROWS_END(slope_price, WR_SCHEME_COUNT);

#define EXACT_PRICE 2.5    /* factor for second derivatives, on curved surfaces */
#define FORMULA_PRICE 20.0 /* F from a formula, for each of its terms */
#define PASS_PRICE 0.4     /* of a pixel that a pass skips */

double wr_price_sample(const WrScene *scene, WrScheme scheme, WrBumpMode mode)
{
    double price = surface_price[scene->shape.kind];
    if (mode == WR_BUMP_NONE) return price;
    price += scene->analytic.kind == WR_ANALYTIC_OFF ? slope_price[scheme] : FORMULA_PRICE;
    return mode == WR_BUMP_EXACT && !wr_surfaces[scene->shape.kind]->flat ? price + EXACT_PRICE
                                                                          : price;
}

double wr_price_pass(int64_t pixels)
{
    return PASS_PRICE * (double)pixels;
}

/* ---- Choice of the cheapest pair and level for each block that together meet the tolerance ---- */

/* Estimates are off by some per cent; the largest error, one pixel of many, by more than a sum. */
#define MARGIN_RMS 0.93 /* parts of the tolerance that are used */
#define MARGIN_MAX 0.75
#define SCATTERED                                                                                  \
    0.12 /* of the time: blocks of several settings are scattered, and short rows are slower */

#define OPTIONS (PAIRS_MAX * LEVELS)

typedef struct Option {
    int pair, level;
    double cost;
    Change off;
} Option;

/* A block with few pixels of the object costs at least as much as one pixel, so that options still differ in
   price. */
static double cost_of(const Study *study, const Block *block, int pair, int level)
{
    const double side = wr_level_side(level);
    return study->pair[pair].price * side * side * fmax(1, block->covered);
}

static int list_options(const Study *study, const Block *block, bool free_pairs,
                        Option out[OPTIONS])
{
    int count = 0;
    for (int pair = 0; pair < study->pairs; pair++)
        for (int level = 0; level < LEVELS; level++) {
            if (!free_pairs && pair != block->pair) continue;
            out[count++] = (Option){ pair, level, cost_of(study, block, pair, level),
                                     wr_study_off(study, block, pair, level) };
        }
    return count;
}

static void take(Block *block, const Option *option)
{
    block->pair = (signed char)option->pair;
    block->pick = (signed char)option->level;
}

/* ---- largest error: each cell separately ---- */

/* The next level's largest change is a poor estimate of the worst pixel if pixels are few: four blocks, two by
   two, get the finest level that one of them needs. */
#define CELL 2

static void raise_cell(Study *study, int u, int v)
{
    Block *highest = NULL;
    for (int pass = 0; pass < 2; pass++)
        for (int y = v; y < v + CELL && y < study->blocks_v; y++)
            for (int x = u; x < u + CELL && x < study->blocks_u; x++) {
                Block *block = &study->block[(int64_t)y * study->blocks_u + x];
                if (!block->shown) continue;
                if (pass > 0) {
                    block->pick = highest->pick;
                    block->pair = highest->pair;
                } else if (!highest || block->pick > highest->pick) {
                    highest = block;
                }
            }
}

/* Each block gets the cheapest option whose largest error is within the limit; if there is none, the most
   accurate. */
static void pick_most(Study *study, double most, bool free_pairs)
{
    for (int64_t b = 0; b < study->count; b++) {
        Block *block = &study->block[b];
        Option options[OPTIONS];
        if (!block->shown) continue;
        const int count = list_options(study, block, free_pairs, options);
        const Option *best = NULL, *nearest = &options[0];
        for (int i = 0; i < count; i++) {
            if (options[i].off.most < nearest->off.most) nearest = &options[i];
            if (options[i].off.most <= most && (!best || options[i].cost < best->cost))
                best = &options[i];
        }
        take(block, best ? best : nearest);
    }
    for (int v = 0; v < study->blocks_v; v += CELL)
        for (int u = 0; u < study->blocks_u; u += CELL) raise_cell(study, u, v);
}

/* ---- sum of errors: by gain per price ---- */

/* A step of a block to a more expensive option, on the lower hull of cost and error.
   Among the options of a block only those on the lower convex hull of (cost, squares) can be optimal for a sum
   over blocks. */
typedef struct Step {
    int64_t block;
    Option to;
    double gain; /* decrease of squares per price */
    double more; /* price */
    double less; /* squares */
} Step;

static int by_cost(const void *a, const void *b)
{
    const Option *x = a, *y = b;
    if (x->cost != y->cost) return x->cost < y->cost ? -1 : 1;
    return (x->off.squares > y->off.squares) - (x->off.squares < y->off.squares);
}

static int by_gain(const void *a, const void *b)
{
    const Step *x = a, *y = b;
    if (x->gain != y->gain) return x->gain > y->gain ? -1 : 1;
    if (x->block != y->block) return x->block < y->block ? -1 : 1;
    return (x->to.cost > y->to.cost) - (x->to.cost < y->to.cost);
}

static double gain_of(const Option *from, const Option *to)
{
    return (from->off.squares - to->off.squares) / fmax(to->cost - from->cost, 1e-300);
}

/* Sorts options by cost; moves those on the lower convex hull to the front. Returns their number.
   Graham's scan: options that cost more without a smaller error are dropped, then the last corner while the
   slope to the new point is steeper than the slope to that corner. */
static int hull(Option *options, int count)
{
    int kept = 0;
    qsort(options, (size_t)count, sizeof *options, by_cost);
    for (int i = 0; i < count; i++) {
        if (kept > 0 && options[i].off.squares >= options[kept - 1].off.squares) continue;
        while (kept > 1 && gain_of(&options[kept - 2], &options[kept - 1]) <=
                               gain_of(&options[kept - 2], &options[i]))
            kept--;
        options[kept++] = options[i];
    }
    return kept;
}

/* Sets every block to its cheapest option, and lists all steps from there, largest gain first.
   steps has room for all options of all blocks. Ties are broken by the block's number: the order must not
   depend on qsort. */
static Step *list_steps(Study *study, bool free_pairs, int64_t *count, Option *sum)
{
    Step *steps = wr_alloc((size_t)study->count * OPTIONS + 1, sizeof *steps);
    *count = 0;
    *sum = (Option){ 0, 0, 0, { 0, 0 } };
    for (int64_t b = 0; b < study->count; b++) {
        Option options[OPTIONS];
        if (!study->block[b].shown) continue;
        const int kept = hull(options, list_options(study, &study->block[b], free_pairs, options));
        take(&study->block[b], &options[0]);
        sum->cost += options[0].cost;
        sum->off.squares += options[0].off.squares;
        for (int i = 1; i < kept; i++)
            steps[(*count)++] = (Step){ b, options[i], gain_of(&options[i - 1], &options[i]),
                                        options[i].cost - options[i - 1].cost,
                                        options[i - 1].off.squares - options[i].off.squares };
    }
    qsort(steps, (size_t)*count, sizeof *steps, by_gain);
    return steps;
}

/* One setting for all that meets `squares` for less than `cost`, or -1.
   Scattered blocks cost a pass for each setting and shorter runs; a single setting for all may be
   cheaper than the sum of the blocks' best. */
static int find_uniform(const Study *study, double squares, double cost)
{
    int found = -1;
    for (int at = 0; at < study->pairs * LEVELS; at++) {
        Option sum = { 0, 0, 0, { 0, 0 } };
        for (int64_t b = 0; b < study->count; b++) {
            const Block *block = &study->block[b];
            if (!block->shown) continue;
            sum.cost += cost_of(study, block, at / LEVELS, at % LEVELS);
            sum.off.squares += wr_study_off(study, block, at / LEVELS, at % LEVELS).squares;
        }
        if (sum.off.squares > squares || sum.cost >= cost) continue;
        cost = sum.cost;
        found = at;
    }
    return found;
}

/* Greedy: steps by decreasing gain until the sum of squares is small enough. On a convex hull the gains of one
   block's steps decrease, so its steps are taken in order.
   This is the Lagrangian relaxation of the choice: the result is optimal but for the last step. */
static void pick_sum(Study *study, double squares, bool free_pairs)
{
    Option sum;
    int64_t count;
    Step *steps = list_steps(study, free_pairs, &count, &sum);
    for (int64_t i = 0; i < count && sum.off.squares > squares; i++) {
        take(&study->block[steps[i].block], &steps[i].to);
        sum.off.squares -= steps[i].less;
    }
    wr_free(steps);
    const int all = free_pairs ? find_uniform(study, squares, wr_study_cost(study)) : -1;
    for (int64_t b = 0; all >= 0 && b < study->count; b++)
        if (study->block[b].shown)
            take(&study->block[b], &(Option){ all / LEVELS, all % LEVELS, 0, { 0, 0 } });
}

/* Greedy, as pick_sum, until the next step would exceed the cost. */
static void pick_within(Study *study, double cost, bool free_pairs)
{
    Option sum;
    int64_t count;
    Step *steps = list_steps(study, free_pairs, &count, &sum);
    cost /= 1 + SCATTERED;
    for (int64_t i = 0; i < count && sum.cost + steps[i].more <= cost; i++) {
        take(&study->block[steps[i].block], &steps[i].to);
        sum.cost += steps[i].more;
    }
    wr_free(steps);
}

/* ---- whole pick ---- */

static void study_pick(Study *study, const WrTolerance *tolerance, bool free_pairs)
{
    const double value = tolerance->value, rms = MARGIN_RMS * value;
    /* 3 values a pixel; pixels counts the covered ones only. */
    if (tolerance->kind == WR_TOLERANCE_MAX) pick_most(study, MARGIN_MAX * value, free_pairs);
    else if (tolerance->kind == WR_TOLERANCE_TIME) pick_within(study, value, free_pairs);
    else pick_sum(study, rms * rms * 3 * fmax(study->pixels, 1), free_pairs);
}

/* Several settings need a pass over the pixels for each, and their blocks are scattered.
   `used` is indexed by setting = pair LEVELS + level. */
double wr_study_cost(const Study *study)
{
    bool used[OPTIONS] = { false };
    double sum = 0;
    int passes = 0;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        if (!block->shown) continue;
        const int at = block->pair * LEVELS + block->pick;
        sum += cost_of(study, block, block->pair, block->pick);
        passes += !used[at];
        used[at] = true;
    }
    const int64_t pixels = (int64_t)study->request->width * study->request->height;
    return passes > 1 ? (1 + SCATTERED) * sum + (passes - 1) * wr_price_pass(pixels) : sum;
}

static Change study_picked_off(const Study *study)
{
    Change sum = { 0, 0 };
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        if (!block->shown) continue;
        const Change off = wr_study_off(study, block, block->pair, block->pick);
        sum.squares += off.squares;
        sum.most = fmax(sum.most, off.most);
    }
    return sum;
}

/* ---- A choice: its parts, its picture, its description ---- */

/* ---- construction ---- */

WR_ROWS(kind_names);
static const char *const kind_names[KIND_COUNT] = { [WR_ROW(KIND_EDGE)] = "edges",
                                                    [WR_ROW(KIND_CALM)] = "calm insides",
                                                    [WR_ROW(KIND_RELIEF)] = "relief",
                                                    [WR_ROW(KIND_ROUGH)] = "rough relief" };
WR_ROWS_END(kind_names, KIND_COUNT);
/* Limits between the kinds that are not edges: root mean square of linear intensity. */
static const double kind_ends[] = { 0.006, 0.03 };
_Static_assert(WR_LENGTH(kind_ends) == KIND_COUNT - KIND_CALM - 1, "an end between two kinds");

static int kind_of(const Block *block)
{
    const double per_value = block->change[1].squares / (3.0 * WR_FRAME_BLOCK * WR_FRAME_BLOCK);
    int kind = KIND_CALM;
    if (block->edge) return KIND_EDGE;
    for (size_t i = 0; i < sizeof kind_ends / sizeof *kind_ends; i++)
        kind += per_value > kind_ends[i] * kind_ends[i];
    return kind;
}

static int setting_of(const Block *block)
{
    return block->pair * LEVELS + block->pick;
}

/* Kinds of the blocks with that setting. */
static unsigned kinds_of(const Study *study, int setting)
{
    int64_t all[KIND_COUNT] = { 0 }, here[KIND_COUNT] = { 0 };
    unsigned kinds = 0;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        if (!block->shown) continue;
        all[kind_of(block)]++;
        here[kind_of(block)] += setting_of(block) == setting;
    }
    for (int k = 0; k < KIND_COUNT; k++) {
        const unsigned has = here[k] == 0           ? HAS_NONE
                             : here[k] == all[k]    ? HAS_ALL
                             : 2 * here[k] > all[k] ? HAS_MAX
                                                    : HAS_SOME;
        kinds |= has << (KIND_BITS * k);
    }
    return kinds;
}

void wr_part_name(WrChoicePart *part)
{
    static const char *const share[] = { "", "some of the ", "most of the ", "" };
    WrText text = { 0 };
    for (int k = 0; k < KIND_COUNT; k++) {
        const unsigned has = part->kinds >> (KIND_BITS * k) & 3;
        if (has != HAS_NONE)
            wr_text_addf(&text, "%s%s%s", text.length > 0 ? ", " : "", share[has], kind_names[k]);
    }
    snprintf(part->where, sizeof part->where, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

void wr_choice_say(WrChoice *choice, const WrTolerance *tolerance, const char *more)
{
    WrText text = { 0 };
    wr_text_addf(&text, "tolerance %s=", wr_tolerance_names[tolerance->kind]);
    wr_text_add_number(&text, tolerance->value);
    wr_text_addf(&text, "%s: %s; estimated rms %.2g, max %.2g; %s",
                 tolerance->kind == WR_TOLERANCE_TIME ? " s" : "",
                 choice->met ? "met" : "CANNOT be promised by any setting: the nearest was taken",
                 choice->rms, choice->max, more);
    snprintf(choice->reason, sizeof choice->reason, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* Converts the study's picks to a choice with its parts, owned by the caller.
   part_of[b] is one byte: at most PARTS_MAX settings exist. Parts are numbered in the order of their first
   block. */
static void study_settle(const Study *study, WrChoice *out)
{
    int part_of[PARTS_MAX];
    out->width = study->request->width;
    out->height = study->request->height;
    out->scene = wr_scene_share(study->request->scene);
    out->tables_key = wr_choice_tables_key(study->request);
    out->turn_deg = study->request->turn_deg;
    out->studies = 1;
    out->frames = study->frames;
    out->parts = wr_alloc(PARTS_MAX, sizeof *out->parts);
    out->part_of = wr_alloc((size_t)study->count, 1);
    for (int i = 0; i < PARTS_MAX; i++) part_of[i] = -1;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        out->part_of[b] = WR_CHOICE_NOTHING;
        if (!block->shown) continue;
        const int setting = setting_of(block);
        if (part_of[setting] < 0) {
            WrChoicePart *part = &out->parts[part_of[setting] = out->count++];
            part->scene = wr_study_scene(study, block->pair, block->pick);
            part->level = block->pick;
            part->price = study->pair[block->pair].price;
            part->kinds = kinds_of(study, setting);
            wr_part_name(part);
        }
        out->part_of[b] = (unsigned char)part_of[setting];
        out->parts[part_of[setting]].blocks++;
    }
    if (out->count == 0) out->parts[out->count++].scene = wr_study_scene(study, 0, 0);
}

void wr_choice_fini(WrChoice *choice)
{
    for (int i = 0; i < choice->count; i++) wr_scene_free(choice->parts[i].scene);
    wr_scene_free((WrScene *)choice->scene);
    wr_free(choice->parts);
    wr_free(choice->part_of);
    *choice = (WrChoice){ 0 };
}

/* ---- use ---- */

/* Clears the blocks without the object, which are not rendered.
   The renderer leaves blocks outside `only` as they were in the frame's memory, so blocks in no part are
   cleared here. */
static void clear_nothing(const WrChoice *choice, WrFrame *frame)
{
    const int blocks_u = (choice->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    for (int y = 0; y < choice->height; y++)
        for (int u = 0; u < blocks_u; u++) {
            const int x = u * WR_FRAME_BLOCK, left = choice->width - x;
            const int w = left < WR_FRAME_BLOCK ? left : WR_FRAME_BLOCK;
            if (choice->part_of[(int64_t)(y / WR_FRAME_BLOCK) * blocks_u + u] == WR_CHOICE_NOTHING)
                memset(frame->rgba + 4 * ((size_t)y * (size_t)choice->width + (size_t)x), 0,
                       4 * (size_t)w * sizeof(float));
        }
}

/* Each part is a pass of the renderer over its own blocks into the same frame. `hold` keeps caches that the
   pass does not use, because the next pass or picture does; dials are those of the part's scene. */
bool wr_choice_frame_plan(WrRenderer *renderer, const WrFrameRequest *request,
                          const WrChoice *choice, WrPlan *plan, WrFrame *frame, WrError *err)
{
    const int64_t blocks = (int64_t)((choice->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK) *
                           ((choice->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK);
    WrFrame sum = { 0 };
    bool good = true;
    if (request->width != choice->width || request->height != choice->height)
        return wr_fail(err, "the dials were chosen for %dx%d pixels, not %dx%d", choice->width,
                       choice->height, request->width, request->height);
    unsigned char *only = wr_alloc((size_t)blocks, 1);
    for (int i = 0; good && i < choice->count; i++) {
        WrFrameRequest pass = *request;
        for (int64_t b = 0; b < blocks; b++) only[b] = choice->part_of[b] == i;
        pass.scene = choice->parts[i].scene;
        pass.dials = NULL;
        pass.only = only;
        pass.keep = false;
        pass.hold = true; /* the next picture's choice needs them all */
        good = wr_renderer_frame(renderer, &pass, frame, err);
        if (!good) break;
        if (plan) wr_plan_add(plan, frame->plan);
        sum.shaded += frame->shaded;
        wr_times_add(&sum.times, &frame->times);
    }
    wr_free(only);
    if (!good) return false;
    clear_nothing(choice, frame);
    frame->covered = wr_frame_covered(frame);
    frame->shaded = sum.shaded;
    frame->times = sum.times;
    if (plan) frame->plan = plan;
    return true;
}

bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err)
{
    return wr_choice_frame_plan(renderer, request, choice, NULL, frame, err);
}

void wr_choice_print(const WrChoice *choice, WrText *text)
{
    int64_t all = 0;
    for (int i = 0; i < choice->count; i++) all += choice->parts[i].blocks;
    for (int i = 0; i < choice->count; i++) {
        const WrChoicePart *part = &choice->parts[i];
        if (part->blocks == 0) continue;
        WrText bump = { 0 }, dials = { 0 };
        wr_dials_print(part->scene, "bump", true, &bump);
        wr_dials_print(part->scene, "dials", false, &dials);
        wr_text_addf(text, "%.1f %% of the blocks, %s: %s %s\n",
                     100.0 * (double)part->blocks / (double)all, part->where, wr_text_get(&bump),
                     wr_text_get(&dials));
        wr_text_fini(&bump);
        wr_text_fini(&dials);
    }
}

/* ---- frames of several passes ---- */

void wr_times_add(WrStageTimes *sum, const WrStageTimes *more)
{
    sum->prepare += more->prepare;
    sum->visibility += more->visibility;
    sum->geometry += more->geometry;
    sum->bump += more->bump;
    sum->shade += more->shade;
    sum->resolve += more->resolve;
    sum->total += more->total;
    sum->pyramid += more->pyramid;
}

int64_t wr_frame_covered(const WrFrame *frame)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    int64_t covered = 0;
    for (size_t i = 0; i < pixels; i++) covered += frame->rgba[4 * i + 3] > 0;
    return covered;
}

/* ---- speed ---- */

/* Time per price on this machine: measured once and stored, so that the same time limit produces the same dials. */

#define RUNS 7
#define SIDE 256
#define KEPT_MAX 4096 /* maximum bytes of the file */

/* $WRINKLE_STATE/speed if that is set, else $XDG_CACHE_HOME/wrinkle/speed, else ~/.cache/wrinkle/speed; creates
   its folder. False: there is no place to store it. */
static bool find_file(WrText *path)
{
    const char *own = getenv("WRINKLE_STATE"), *cache = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    if (own && *own) wr_text_add(path, own);
    else if (cache && cache[0] == '/') wr_text_addf(path, "%s", cache);
    else if (home && home[0] == '/') wr_text_addf(path, "%s/.cache", home);
    else return false;
    wr_folder_make(wr_text_get(path),
                   WR_FOLDER_FOR_ME); /* usually it exists; otherwise the write fails */
    if (!own || !*own) {
        wr_text_add(path, "/wrinkle");
        wr_folder_make(wr_text_get(path), WR_FOLDER_FOR_ME);
    }
    wr_text_add(path, "/speed");
    return true;
}

/* "2 threads, level 3: ": prefix of the line for this configuration. */
static void name_line(const WrRenderer *renderer, WrText *out)
{
    wr_text_addf(out, "1 %d %s %d ", wr_renderer_threads(renderer), wr_renderer_isa(renderer),
                 wr_cpu_level());
}

/* Seconds per price on the line with that prefix; 0: there is none.
   The line's prefix contains threads, instruction set and processor level: a file shared by machines keeps
   them apart. */
static double find_line(const char *text, const char *start)
{
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (strncmp(line, start, strlen(start)) != 0) continue;
        const char *number = line + strlen(start);
        double value;
        return wr_number_parse(number, strcspn(number, "\n"), &value) && value > 1e-13 &&
                       value < 1e-3
                   ? value
                   : 0;
    }
    return 0;
}

/* The fastest of several frames: other load can only make them slower.
   The first run builds caches and is not counted. Bump is forced on: an empty table would be planned away
   (E6). */
static bool measure(WrRenderer *renderer, double *out, WrError *err)
{
    WrField *field = wr_field_new(64, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
    if (!field) return false;
    WrScene *scene = wr_scene_new();
    static const WrForce force[WR_EFFECT_COUNT] = { [WR_EFFECT_BUMP] = WR_FORCE_ON };
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .force = force
    };
    double best = INFINITY;
    bool good = true;
    for (int run = 0; good && run < RUNS; run++) {
        WrFrame frame;
        const double start = wr_clock_seconds();
        good = wr_renderer_frame(renderer, &request, &frame, err);
        const double took = wr_clock_seconds() - start;
        const double price = wr_price_sample(scene, scene->scheme, scene->bump);
        if (good && run > 0 && frame.shaded > 0)
            best = fmin(best, took / (price * (double)frame.shaded));
    }
    wr_scene_free(scene);
    wr_field_free(field);
    *out = best;
    return good;
}

static void keep(const char *path, const char *text, const char *line, double value)
{
    WrText all = { 0 };
    wr_text_add(&all, text);
    wr_text_add(&all, line);
    wr_text_add_number(&all, value);
    wr_text_add(&all, "\n");
    wr_file_write(path, wr_text_get(&all), all.length, NULL);
    wr_text_fini(&all);
}

/* Seconds per price on this machine with that many threads: measured once and stored in a file, so that the same
   time limit produces the same dials. The renderer's last picture is lost. */
static bool price_seconds(WrRenderer *renderer, double *out, WrError *err)
{
    WrText path = { 0 }, line = { 0 };
    char *text = NULL;
    size_t length;
    const bool kept = find_file(&path);
    name_line(renderer, &line);
    if (!kept || !wr_file_read(wr_text_get(&path), KEPT_MAX, &text, &length, NULL)) text = NULL;
    double value = text ? find_line(text, wr_text_get(&line)) : 0;
    bool good = value > 0 || measure(renderer, &value, err);
    if (good && kept && !(text && find_line(text, wr_text_get(&line)) > 0))
        keep(wr_text_get(&path), text ? text : "", wr_text_get(&line), value);
    *out = value;
    wr_free(text);
    wr_text_fini(&path);
    wr_text_fini(&line);
    return good;
}

/* ---- turn ---- */

/* One choice for all frames of a turntable animation: chosen on a few frames spread over it, each block with the
   most expensive setting of any. Frames between those are tested, where the error is estimated at a fraction of
   a frame's cost. */

#define STUDIED_MAX 4   /* frames for which dials are chosen ... */
#define STUDIED_SHARE 4 /* ... and at most one of this many */
#define LOOKED_SHARE 8  /* one of this many of each part's blocks is tested */
#define COARSER_LOOK                                                                               \
    1.3 /* error of the coarser, relative to the squared change by twice as many samples a side */

/* ---- union of the choices of two frames ---- */

/* The choice's part with the level of one part and the slopes and normal of the other; created if missing. */
static int find_part(WrChoice *choice, const WrChoicePart *level, const WrChoicePart *pair)
{
    const WrScene *wanted = pair->scene;
    for (int i = 0; i < choice->count; i++) {
        const WrScene *scene = choice->parts[i].scene;
        if (choice->parts[i].level == level->level && scene->scheme == wanted->scheme &&
            scene->bump == wanted->bump)
            return i;
    }
    WrChoicePart *part = &choice->parts[choice->count];
    *part = *level;
    part->scene = wr_scene_clone(level->scene);
    part->scene->scheme = wanted->scheme;
    part->scene->bump = wanted->bump;
    part->price = pair->price;
    part->blocks = 0;
    return choice->count++;
}

static int64_t blocks_of(const WrChoice *choice)
{
    return (int64_t)((choice->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK) *
           ((choice->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK);
}

static void count_blocks(WrChoice *choice)
{
    for (int i = 0; i < choice->count; i++) choice->parts[i].blocks = 0;
    for (int64_t b = 0; b < blocks_of(choice); b++)
        if (choice->part_of[b] != WR_CHOICE_NOTHING) choice->parts[choice->part_of[b]].blocks++;
}

/* The finest level and the most expensive slopes and normal of four blocks, two by two: features move between
   blocks during a turn. */
static void find_dearest(const WrChoice *choice, int64_t b, WrChoicePart *level, WrChoicePart *pair)
{
    const int64_t across = (choice->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    const int64_t u = b % across / 2 * 2, v = b / across / 2 * 2;
    for (int64_t n = 0; n < 4; n++) {
        const int64_t x = u + n % 2, at = (v + n / 2) * across + x;
        if (x >= across || at >= blocks_of(choice) || choice->part_of[at] == WR_CHOICE_NOTHING)
            continue;
        const WrChoicePart *part = &choice->parts[choice->part_of[at]];
        if (part->level > level->level) *level = *part;
        if (part->price > pair->price) *pair = *part;
    }
}

/* Each block gets the finest level and the most expensive slopes and normal of both. A maximum of
   levels and prices over the studied frames: a further frame can only make the choice finer. */
static void merge(WrChoice *sum, const WrChoice *more)
{
    for (int64_t b = 0; b < blocks_of(sum); b++) {
        const bool empty = sum->part_of[b] == WR_CHOICE_NOTHING;
        if (more->part_of[b] == WR_CHOICE_NOTHING) continue;
        WrChoicePart level = empty ? more->parts[more->part_of[b]] : sum->parts[sum->part_of[b]];
        WrChoicePart pair = level;
        find_dearest(more, b, &level, &pair);
        sum->part_of[b] = (unsigned char)find_part(sum, &level, &pair);
    }
    sum->met = sum->met && more->met;
    sum->rms = fmax(sum->rms, more->rms);
    sum->max = fmax(sum->max, more->max);
    sum->top_seconds = fmax(sum->top_seconds, more->top_seconds);
}

/* Blocks that are empty on all studied frames may contain the object on another: they get the finest setting,
   which costs nothing on empty blocks. */
static void fill_nothing(WrChoice *choice)
{
    int finest = 0;
    for (int i = 1; i < choice->count; i++) {
        const WrChoicePart *part = &choice->parts[i], *best = &choice->parts[finest];
        if (part->level > best->level || (part->level == best->level && part->price > best->price))
            finest = i;
    }
    for (int64_t b = 0; b < blocks_of(choice); b++)
        if (choice->part_of[b] == WR_CHOICE_NOTHING) choice->part_of[b] = (unsigned char)finest;
    count_blocks(choice);
}

/* ---- test of a frame ---- */

typedef struct Look {
    WrRenderer *renderer;
    const WrFrameRequest *request;
    const WrChoice *choice;
    float *coarse;       /* the frame as chosen */
    unsigned char *only; /* the tested blocks of a part */
    double squares, most;
} Look;

/* Selects one in LOOKED_SHARE of a part's blocks into `only`. Returns their number.
   Every LOOKED_SHARE-th block of the part, beginning in the middle of the first run: evenly spread and
   repeatable. */
static int64_t draw(const Look *look, int part)
{
    int64_t passed = 0, drawn = 0;
    for (int64_t b = 0; b < blocks_of(look->choice); b++) {
        look->only[b] =
            look->choice->part_of[b] == part && passed++ % LOOKED_SHARE == LOOKED_SHARE / 2;
        drawn += look->only[b];
    }
    return drawn;
}

static double add_difference(Look *look, const WrFrame *fine)
{
    const int blocks_u = (fine->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    double squares = 0;
    for (int y = 0; y < fine->height; y++)
        for (int x = 0; x < fine->width; x++) {
            const size_t at = 4 * ((size_t)y * (size_t)fine->width + (size_t)x);
            if (!look->only[(int64_t)(y / WR_FRAME_BLOCK) * blocks_u + x / WR_FRAME_BLOCK])
                continue;
            for (size_t c = at; c < at + 3; c++) {
                const double d = (double)fine->rgba[c] - (double)look->coarse[c];
                squares += d * d;
                look->most = fmax(look->most, fabs(d));
            }
        }
    return squares;
}

/* Renders some blocks of a part with twice as many samples a side, to estimate the error of all of it.
   The squared change to twice the samples underestimates the coarser picture's error, as the finer one has an
   error too: the factor COARSER_LOOK. The sum over the drawn blocks is scaled to all blocks of the part. */
static bool look_at_part(Look *look, int index, WrError *err)
{
    const WrChoicePart *part = &look->choice->parts[index];
    const int64_t drawn = draw(look, index);
    WrFrame fine;
    if (drawn == 0) return true;
    WrScene *scene = wr_scene_clone(part->scene);
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    scene->dials.samples = 2 * wr_level_side(part->level);
    WrFrameRequest request = *look->request;
    request.scene = scene;
    request.dials = NULL;
    request.only = look->only;
    request.hold = true;
    const bool good = wr_renderer_frame(look->renderer, &request, &fine, err);
    if (good)
        look->squares +=
            COARSER_LOOK * add_difference(look, &fine) * (double)part->blocks / (double)drawn;
    wr_scene_free(scene);
    return good;
}

/* Approximate error of a frame of another turn with those dials; *seconds: time of the frame itself. */
static bool look_at(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                    double *rms, double *most, double *seconds, WrError *err)
{
    WrFrame frame;
    const double start = wr_clock_seconds();
    if (!wr_choice_frame(renderer, request, choice, &frame, err)) return false;
    *seconds = wr_clock_seconds() - start;
    const size_t floats = (size_t)4 * (size_t)frame.width * (size_t)frame.height;
    Look look = { .renderer = renderer, .request = request, .choice = choice };
    look.coarse = wr_try_alloc(floats, sizeof(float), "a picture", err);
    if (!look.coarse) return false;
    look.only = wr_alloc((size_t)blocks_of(choice), 1);
    memcpy(look.coarse, frame.rgba, floats * sizeof(float));
    bool good = true;
    for (int i = 0; good && i < choice->count; i++) good = look_at_part(&look, i, err);
    *rms = sqrt(look.squares / (3 * fmax(1, (double)frame.covered)));
    *most = look.most;
    wr_free(look.coarse);
    wr_free(look.only);
    return good;
}

/* ---- all frames ---- */

/* `count` angles in turn order; the studied ones are i count / studied, the tested ones lie half-way between. */

typedef struct Turn {
    WrRenderer *renderer;
    WrFrameRequest request;
    WrChoice choice;
    int studied, checked, again; /* numbers of frames */
    double study_seconds, frame_seconds, rms;
} Turn;

static bool study(Turn *turn, double turn_deg, WrError *err)
{
    WrFrame frame;
    WrChoice one = { 0 };
    turn->request.turn_deg = turn_deg;
    if (!wr_tolerance_choose(turn->renderer, &turn->request, &one, &frame, err)) return false;
    turn->study_seconds += one.spent;
    if (turn->studied++ == 0) {
        turn->choice = one;
        merge(&turn->choice, &turn->choice);
        return true;
    }
    merge(&turn->choice, &one);
    wr_choice_fini(&one);
    return true;
}

/* Tests a frame. If the choice fails there, that frame is studied too.
   A repeated study only adds finer settings (merge), so the loop cannot oscillate. */
static bool check(Turn *turn, double turn_deg, WrError *err)
{
    const WrTolerance *tolerance = &turn->request.scene->tolerance;
    double rms, most, seconds;
    turn->request.turn_deg = turn_deg;
    if (!look_at(turn->renderer, &turn->request, &turn->choice, &rms, &most, &seconds, err))
        return false;
    turn->checked++;
    turn->frame_seconds += seconds;
    const bool broken = (tolerance->kind == WR_TOLERANCE_RMS && rms > tolerance->value) ||
                        (tolerance->kind == WR_TOLERANCE_MAX && most > tolerance->value);
    if (!broken || !turn->choice.met) {
        turn->rms = fmax(turn->rms, rms);
        return true;
    }
    turn->again++;
    if (!study(turn, turn_deg, err)) return false;
    fill_nothing(&turn->choice);
    return true;
}

static void print_turn(Turn *turn, int count, double spent)
{
    const WrTolerance *tolerance = &turn->request.scene->tolerance;
    WrChoice *choice = &turn->choice;
    const double each = turn->checked > 0 ? turn->frame_seconds / turn->checked : choice->seconds;
    const double anew = turn->study_seconds / turn->studied, gain = anew - each;
    WrText text = { 0 };
    wr_text_addf(&text, "tolerance %s=", wr_tolerance_names[tolerance->kind]);
    wr_text_add_number(&text, tolerance->value);
    wr_text_addf(&text,
                 "%s, %d frames: %s; dials chosen on %d of them for all, checked on %d others%s; "
                 "estimated rms at most %.2g; choosing took %.1f ms, each frame %.1f; ",
                 tolerance->kind == WR_TOLERANCE_TIME ? " s" : "", count,
                 choice->met ? "met" : "CANNOT be promised by any setting: the nearest was taken",
                 turn->studied, turn->checked, turn->again > 0 ? ", which mended them" : "",
                 fmax(choice->rms, turn->rms), 1e3 * spent, 1e3 * each);
    if (gain > 0 && spent / gain < 1e6)
        wr_text_addf(&text, "against choosing for each it pays from frame %d on",
                     (int)ceil(spent / gain));
    else wr_text_add(&text, "against choosing for each it never pays");
    snprintf(choice->reason, sizeof choice->reason, "%s", wr_text_get(&text));
    wr_text_fini(&text);
    choice->seconds = each;
    choice->spent = spent;
}

bool wr_tolerance_turn(WrRenderer *renderer, const WrFrameRequest *request, const double *turn_deg,
                       int count, WrChoice *out, WrError *err)
{
    Turn turn = { .renderer = renderer, .request = *request };
    const double start = wr_clock_seconds();
    const int share = count / STUDIED_SHARE;
    const int studied = share < 1 ? 1 : share < STUDIED_MAX ? share : STUDIED_MAX;
    bool good = true;
    for (int i = 0; good && i < studied; i++)
        good = study(&turn, turn_deg[(int64_t)i * count / studied], err);
    if (good) fill_nothing(&turn.choice);
    for (int i = 0; good && i < studied && count > 1; i++) {
        const int at = (int)((2 * (int64_t)i + 1) * count / (2 * studied));
        good = check(&turn, turn_deg[at < count ? at : count - 1], err);
    }
    if (!good) {
        wr_choice_fini(&turn.choice);
        return false;
    }
    turn.choice.turning = true;
    turn.choice.studies = turn.studied;
    print_turn(&turn, count, wr_clock_seconds() - start);
    wr_choice_fini(out);
    *out = turn.choice;
    return true;
}

#define CLIMBS 16 /* maximum rounds, each of one level for the blocks that need it */
#define PROBINGS 3
/* blocks of a level that need the next: from this number on, one in AHEAD of them goes first */
#define MANY 16
#define AHEAD 4
/* the expected saving of cheaper slopes must be this many times the cost of testing them */
#define WORTH 2.0

/* ---- slopes and normals ---- */

/* The best pair is the truth for all others: their difference to it at one sample a pixel is their error,
   added to that of the samples. */

static void add_pair(Study *study, WrScheme scheme, WrBumpMode mode)
{
    const WrScene *scene = study->request->scene;
    study->pair[study->pairs++] = (Pair){ scheme, mode, wr_price_sample(scene, scheme, mode) };
}

/* Adds the best pair first: shared by all objects. */
static void add_best_pair(Study *study)
{
    const WrScene *scene = study->request->scene;
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF;
    bool flat = true;
    for (int i = 0; i < wr_scene_object_count(scene); i++)
        flat = flat && wr_surfaces[wr_scene_object(scene, i)->shape.kind]->flat;
    add_pair(study, table ? WR_SCHEME_BSPLINE_FIT : scene->scheme,
             scene->bump == WR_BUMP_INVARIANT ? WR_BUMP_INVARIANT
             : flat                           ? WR_BUMP_BLINN
                                              : WR_BUMP_EXACT);
}

/* Adds cheaper pairs if testing them may pay: they are rendered for all visible blocks with one sample each.
   A pair is worth testing if its expected saving exceeds WORTH times the price of rendering it once for all
   shown pixels. */
static bool add_cheaper(Study *study, double expected, WrError *err)
{
    const WrScene *scene = study->request->scene;
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF;
    const Pair best = study->pair[0];
    const WrBumpMode mode = best.mode == WR_BUMP_EXACT ? WR_BUMP_BLINN : best.mode;
    const Pair cheaper[] = { { best.scheme, WR_BUMP_NONE, 0 },
                             { table ? WR_SCHEME_BILINEAR : best.scheme, mode, 0 },
                             { best.scheme, mode, 0 } };
    for (size_t i = 0; i < sizeof cheaper / sizeof *cheaper; i++) {
        const Pair *pair = &cheaper[i];
        if (pair->scheme == best.scheme && pair->mode == best.mode) continue;
        const double price = wr_price_sample(scene, pair->scheme, pair->mode);
        if ((1 - price / best.price) * expected < WORTH * price * study->pixels) continue;
        add_pair(study, pair->scheme, pair->mode);
        if (!wr_study_formula(study, study->pairs - 1, err)) return false;
    }
    return true;
}

/* ---- climbing ---- */

/* Marks the blocks that need the next level. Returns their number. */
static int64_t find_climbers(const Study *study, unsigned char *wanted)
{
    int64_t climbers = 0;
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        wanted[b] = block->shown && block->pick > block->level;
        climbers += wanted[b];
    }
    return climbers;
}

/* If many blocks of a level need the next and the accuracy of that estimate is unknown, only some of them climb
   first: their actual errors may show that the others can stay.
   Rendering all of them at once would be wasted if the estimate was too high; MANY / AHEAD results are enough
   to correct it. */
static void send_some_ahead(const Study *study, unsigned char *wanted)
{
    int64_t climbers[LEVELS][2] = { { 0 } }, passed[LEVELS][2] = { { 0 } };
    for (int64_t b = 0; b < study->count; b++)
        climbers[study->block[b].level][study->block[b].edge] += wanted[b];
    for (int64_t b = 0; b < study->count; b++) {
        const Block *block = &study->block[b];
        if (!wanted[b] || block->level == 0) continue;
        if (climbers[block->level][block->edge] < MANY) continue;
        if (study->learnt[block->level][block->edge].blocks >= MANY / AHEAD) continue;
        wanted[b] = passed[block->level][block->edge]++ % AHEAD == 0;
    }
}

/* Climbs until no block needs a level that it has not been rendered at. */
static bool climb(Study *study, const WrTolerance *tolerance, WrError *err)
{
    unsigned char *wanted = wr_alloc((size_t)study->count, 1);
    bool good = true;
    for (int round = 0; good && round < CLIMBS; round++) {
        if (find_climbers(study, wanted) == 0) break;
        if (tolerance->kind != WR_TOLERANCE_MAX) send_some_ahead(study, wanted);
        good = wr_study_climb(study, wanted, err);
        if (tolerance->kind != WR_TOLERANCE_MAX) wr_study_learn(study);
        if (good) study_pick(study, tolerance, false);
    }
    wr_free(wanted);
    return good;
}

/* Probes compare some blocks with a much finer level. If they find a larger error than estimated, the
   estimates of that level are raised and the pick is repeated, at most PROBINGS times. */
static bool climb_and_probe(Study *study, const WrTolerance *tolerance, WrError *err)
{
    for (int probing = 0; probing <= PROBINGS; probing++) {
        bool worse = false;
        if (!climb(study, tolerance, err)) return false;
        if (probing == PROBINGS || tolerance->kind == WR_TOLERANCE_TIME) break;
        if (!wr_study_probe(study, &worse, err)) return false;
        study_pick(study, tolerance, false);
        if (!worse) break;
    }
    return climb(study, tolerance, err);
}

/* Order: one sample a pixel everywhere; the survey at 2 x 2 of some blocks; cheaper pairs; climbing. Doubt
   factors start at 1. */
static bool run(Study *study, const WrTolerance *tolerance, WrError *err)
{
    add_best_pair(study);
    for (int level = 0; level < LEVELS; level++) study->doubt[level] = (Doubt){ 1, 1, 0 };
    if (!wr_study_begin(study, tolerance, err)) return false;
    if (wr_study_best_is_cheaper(study, tolerance))
        return wr_study_take_best(study, err) && wr_study_compose(study, err);
    if (!wr_study_survey(study, tolerance, err)) return false;
    study_pick(study, tolerance, true);
    /* One sample a pixel shows the total change, but not the largest. */
    if (tolerance->kind != WR_TOLERANCE_MAX && !add_cheaper(study, wr_study_cost(study), err))
        return false;
    study_pick(study, tolerance, true);
    return climb_and_probe(study, tolerance, err) && wr_study_compose(study, err);
}

/* ---- result ---- */

static bool holds(const WrTolerance *tolerance, const WrChoice *choice)
{
    switch (tolerance->kind) {
    case WR_TOLERANCE_RMS: return choice->rms <= tolerance->value;
    case WR_TOLERANCE_MAX: return choice->max <= tolerance->value;
    case WR_TOLERANCE_TIME: return choice->seconds <= tolerance->value;
    case WR_TOLERANCE_NONE:
    case WR_TOLERANCE_COUNT: break;
    }
    return true;
}

static void print_reason(const WrTolerance *tolerance, WrChoice *out)
{
    char more[160];
    snprintf(more, sizeof more,
             "choosing and the picture took %.1f ms; one more such frame costs %.1f, 16 x 16 "
             "samples everywhere %.1f",
             1e3 * out->spent, 1e3 * out->seconds, 1e3 * out->top_seconds);
    wr_choice_say(out, tolerance, more);
}

static double top_cost(const Study *study)
{
    double sum = 0;
    for (int64_t b = 0; b < study->count; b++)
        if (study->block[b].shown) sum += fmax(1, study->block[b].covered);
    return sum * study->pair[0].price * wr_level_side(TOP) * wr_level_side(TOP);
}

static void tell(const Study *study, const WrTolerance *tolerance, double start, WrChoice *out)
{
    const Change off = study_picked_off(study);
    const double pace = study->spent > 0 ? study->seconds / study->spent : 0;
    study_settle(study, out);
    out->rms = wr_study_rms(study, off.squares);
    out->max = off.most;
    out->seconds = pace * wr_study_cost(study);
    out->top_seconds = pace * top_cost(study);
    out->spent = wr_clock_seconds() - start;
    out->met = holds(tolerance, out);
    print_reason(tolerance, out);
}

/* ---- interface ---- */

bool wr_tolerance_choose(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *out,
                         WrFrame *frame, WrError *err)
{
    WrTolerance tolerance = request->scene->tolerance;
    const double start = wr_clock_seconds();
    double price = 1;
    if (tolerance.kind == WR_TOLERANCE_NONE)
        return wr_fail(err, "the scene has no tolerance: set one with `tolerance rms=0.004`");
    if (tolerance.kind == WR_TOLERANCE_TIME && !price_seconds(renderer, &price, err)) return false;
    Study study = { .renderer = renderer,
                    .request = request,
                    .frame = frame,
                    .blocks_u = (request->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK,
                    .blocks_v = (request->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK };
    WrChoice choice = { 0 };
    study.count = (int64_t)study.blocks_u * study.blocks_v;
    study.block = wr_alloc((size_t)study.count, sizeof *study.block);
    study.mask = wr_alloc((size_t)study.count, 1);
    /* A time limit becomes a limit of price units; all other tolerances are in linear intensity, price 1. */
    tolerance.value /= price;
    const bool good = run(&study, &tolerance, err);
    if (good) {
        tell(&study, &request->scene->tolerance, start, &choice);
        wr_choice_fini(out);
        *out = choice;
        out->plan = study.plan;
        out->plan.cost[WR_COST_CHOOSE] = fmax(0, out->spent - study.times.total);
        out->plan.work += out->plan.cost[WR_COST_CHOOSE];
        frame->plan = &out->plan;
        frame->times.total = out->spent;
    }
    wr_study_fini(&study);
    return good;
}

/* The table of object i; NULL: it is not visible. */
static const WrField *table_of(const WrFrameRequest *request, int i)
{
    if (wr_scene_object(request->scene, i)->hidden) return NULL;
    return request->fields && request->fields[i] ? request->fields[i] : request->field;
}

/* True if all objects use the composite. */
static bool is_common(const WrFrameRequest *request)
{
    const int count = wr_scene_object_count(request->scene);
    for (int i = 0; i < count && request->fields; i++)
        if (request->fields[i]) return false;
    return true;
}

/* With one table for all objects the key is the table's; else a hash over the objects in order, hidden ones as
   0. */
uint64_t wr_choice_tables_key(const WrFrameRequest *request)
{
    WrHash all = { 0, 0 };
    if (is_common(request)) return wr_field_key(request->field);
    for (int i = 0; i < wr_scene_object_count(request->scene); i++) {
        const WrField *field = table_of(request, i);
        const uint64_t key = field ? wr_field_key(field) : 0;
        all = wr_hash_bytes(&key, sizeof key, all);
    }
    return all.low;
}

WrHash wr_choice_tables_hash(const WrFrameRequest *request)
{
    WrHash all = { 0, 0 };
    if (is_common(request)) return wr_field_hash(request->field);
    for (int i = 0; i < wr_scene_object_count(request->scene); i++) {
        const WrField *field = table_of(request, i);
        const WrHash own = field ? wr_field_hash(field) : (WrHash){ 0, 0 };
        all = wr_hash_bytes(&own, sizeof own, all);
    }
    return all;
}

bool wr_choice_fits(const WrChoice *choice, const WrFrameRequest *request)
{
    return choice->count > 0 && choice->scene == request->scene &&
           choice->tables_key == wr_choice_tables_key(request) &&
           (choice->turning || choice->turn_deg == request->turn_deg) &&
           choice->width == request->width && choice->height == request->height;
}

bool wr_tolerance_frame(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *choice,
                        WrFrame *frame, WrError *err)
{
    if (!wr_choice_fits(choice, request))
        return wr_tolerance_choose(renderer, request, choice, frame, err);
    choice->plan = (WrPlan){ 0 };
    if (!wr_choice_frame_plan(renderer, request, choice, &choice->plan, frame, err)) return false;
    /* it was read from text: the time is unknown */
    if (choice->studies == 0) choice->seconds = frame->times.total;
    return true;
}
