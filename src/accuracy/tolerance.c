/* Choice under a tolerance: blocks get finer levels until it is met. */
#include "accuracy/tolerance.h"

#include "accuracy/tolerance_internal.h"
#include "field/scheme_list.h"
#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <math.h>

#define CLIMBS 16 /* maximum rounds, each of one level for the blocks that need it */
#define PROBINGS 3
/* blocks of a level that need the next: from this number on, one in AHEAD of them goes first */
#define MANY 16
#define AHEAD 4
/* the expected saving of cheaper slopes must be this many times the cost of testing them */
#define WORTH 2.0

/* ---- slopes and normals ---- */

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

/* Adds cheaper pairs if testing them may pay: they are rendered for all visible blocks with one sample each. */
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
   first: their actual errors may show that the others can stay. */
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
        if (good) wr_study_pick(study, tolerance, false);
    }
    wr_free(wanted);
    return good;
}

static bool climb_and_probe(Study *study, const WrTolerance *tolerance, WrError *err)
{
    for (int probing = 0; probing <= PROBINGS; probing++) {
        bool worse = false;
        if (!climb(study, tolerance, err)) return false;
        if (probing == PROBINGS || tolerance->kind == WR_TOLERANCE_TIME) break;
        if (!wr_study_probe(study, &worse, err)) return false;
        wr_study_pick(study, tolerance, false);
        if (!worse) break;
    }
    return climb(study, tolerance, err);
}

static bool run(Study *study, const WrTolerance *tolerance, WrError *err)
{
    add_best_pair(study);
    for (int level = 0; level < LEVELS; level++) study->doubt[level] = (Doubt){ 1, 1, 0 };
    if (!wr_study_begin(study, tolerance, err)) return false;
    if (wr_study_best_is_cheaper(study, tolerance))
        return wr_study_take_best(study, err) && wr_study_compose(study, err);
    if (!wr_study_survey(study, tolerance, err)) return false;
    wr_study_pick(study, tolerance, true);
    /* One sample a pixel shows the total change, but not the largest. */
    if (tolerance->kind != WR_TOLERANCE_MAX && !add_cheaper(study, wr_study_cost(study), err))
        return false;
    wr_study_pick(study, tolerance, true);
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

static void say_reason(const WrTolerance *tolerance, WrChoice *out)
{
    char more[160];
    snprintf(more, sizeof more,
             "choosing and the picture took %.1f ms, one more such frame takes %.1f, 16 x 16 "
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
    const Change off = wr_study_picked_off(study);
    const double pace = study->spent > 0 ? study->seconds / study->spent : 0;
    wr_study_settle(study, out);
    out->rms = wr_study_rms(study, off.squares);
    out->max = off.most;
    out->seconds = pace * wr_study_cost(study);
    out->top_seconds = pace * top_cost(study);
    out->spent = wr_clock_seconds() - start;
    out->met = holds(tolerance, out);
    say_reason(tolerance, out);
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
    if (tolerance.kind == WR_TOLERANCE_TIME && !wr_price_seconds(renderer, &price, err))
        return false;
    Study study = { .renderer = renderer,
                    .request = request,
                    .frame = frame,
                    .blocks_u = (request->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK,
                    .blocks_v = (request->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK };
    WrChoice choice = { 0 };
    study.count = (int64_t)study.blocks_u * study.blocks_v;
    study.block = wr_alloc((size_t)study.count, sizeof *study.block);
    study.mask = wr_alloc((size_t)study.count, 1);
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
