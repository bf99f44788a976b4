#include "accuracy/effect_savings.h"

#include "accuracy/accuracy_benchmark_internal.h"
#include "base/progress.h"
#include "render/frame/frame.h"

#include <math.h>

#define RUNS_MIN 3
#define MAX_RUNS 25
#define SECONDS 0.5 /* minimum time for an effect's runs */

/* One of the two alternating renderers. */
typedef struct Side {
    WrRenderer *renderer;
    WrForce force[WR_EFFECT_COUNT];
    WrPlan plan;    /* of the last frame */
    double seconds; /* of the last frame */
} Side;

typedef struct Measure {
    const WrSavingRequest *request;
    Side planned, forced;
} Measure;

static bool render(const Measure *m, Side *side, WrError *err)
{
    WrFrameRequest request = *m->request->frame;
    WrFrame frame;
    request.force = side->force;
    if (!wr_renderer_frame(side->renderer, &request, &frame, err)) return false;
    side->plan = *frame.plan;
    side->seconds = frame.times.total;
    return true;
}

/* ---- forceable effects ---- */

static const char *why_not(const WrPlanRow *row, const WrEffectInfo *info)
{
    if (row->run && info->only_way && row->verdict == WR_VERDICT_RUN)
        return "cannot be forced: there is no picture without it";
    if (!row->run && row->verdict == WR_VERDICT_NONE)
        return "cannot be forced: nothing in the scene needs it";
    return NULL;
}

/* Reason why the two frames do not differ in the effect, by the stages that the renderer recorded as run; else
   NULL. */
static const char *not_turned(const WrPlanRow *planned, const WrPlanRow *forced)
{
    if (planned->run == forced->run) return "cannot be forced: the plan keeps to it";
    if (planned->run != planned->ran || forced->run != forced->ran)
        return "not measured: no pixel of this picture runs it";
    return NULL;
}

/* ---- measurement of one effect ---- */

static WrEffects also_turned(const Measure *m, WrEffect effect)
{
    WrEffects also = 0;
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        if (e != (int)effect && m->planned.plan.rows[e].run != m->forced.plan.rows[e].run)
            also |= WR_EFFECT_BIT(e);
    return also;
}

static int runs_of(double pair)
{
    const double runs = pair > 0 ? SECONDS / pair : MAX_RUNS;
    return runs < RUNS_MIN ? RUNS_MIN : runs > MAX_RUNS ? MAX_RUNS : (int)runs;
}

/* One frame of each, alternating which comes first, so that drift of the machine favours neither. */
static bool take_turn(Measure *m, int run, WrError *err)
{
    Side *first = run & 1 ? &m->planned : &m->forced;
    Side *second = run & 1 ? &m->forced : &m->planned;
    return render(m, first, err) && render(m, second, err);
}

static double median(double *values, int count)
{
    wr_bench_sort(values, count);
    return wr_bench_quantile(values, count, 0.5);
}

static void settle(WrSaving *saving, double *more, double *planned, double *forced, int runs)
{
    saving->runs = runs;
    saving->planned = median(planned, runs);
    saving->forced = median(forced, runs);
    saving->seconds = median(more, runs);
    saving->spread = wr_bench_quantile(more, runs, 0.75) - wr_bench_quantile(more, runs, 0.25);
    saving->noise = fabs(saving->seconds) <= saving->spread;
}

static bool measure_one(Measure *m, WrEffect effect, WrSaving *saving, WrError *err)
{
    const WrPlanRow *planned = &m->planned.plan.rows[effect];
    const WrPlanRow *forced = &m->forced.plan.rows[effect];
    double more[MAX_RUNS], as_planned[MAX_RUNS], as_forced[MAX_RUNS];
    *saving = (WrSaving){ .run = planned->run, .tiles = planned->tiles, .pixels = planned->pixels };
    saving->why_not = why_not(planned, &wr_effects[effect]);
    if (saving->why_not) return true;
    m->forced.force[effect] = planned->run ? WR_FORCE_OFF : WR_FORCE_ON;
    bool good = render(m, &m->forced, err); /* builds the table copies that it needs */
    const int runs = runs_of(m->forced.seconds + m->planned.seconds);
    for (int i = 0; good && i < runs && !saving->why_not; i++) {
        saving->why_not = not_turned(planned, forced);
        if (saving->why_not || !(good = take_turn(m, i, err))) break;
        as_planned[i] = m->planned.seconds;
        as_forced[i] = m->forced.seconds;
        more[i] = saving->run ? as_planned[i] - as_forced[i] : as_forced[i] - as_planned[i];
    }
    if (good && !saving->why_not) saving->why_not = not_turned(planned, forced);
    m->forced.force[effect] = WR_FORCE_NONE;
    if (!good || saving->why_not) return good;
    saving->also = also_turned(m, effect);
    if (!saving->run) saving->tiles = forced->tiles, saving->pixels = forced->pixels;
    settle(saving, more, as_planned, as_forced, runs);
    return true;
}

bool wr_savings_measure(const WrSavingRequest *request, WrSaving savings[WR_EFFECT_COUNT],
                        WrError *err)
{
    Measure m = { .request = request };
    m.planned.renderer = wr_renderer_new(request->pool, request->isa, err);
    m.forced.renderer =
        m.planned.renderer ? wr_renderer_new(request->pool, request->isa, err) : NULL;
    bool good = m.forced.renderer && render(&m, &m.planned, err) && render(&m, &m.planned, err);
    for (int e = 0; good && e < WR_EFFECT_COUNT; e++) {
        WrProgressPart part;
        const WrProgress *before =
            wr_progress_enter(&part, (double)e / WR_EFFECT_COUNT, (e + 1.0) / WR_EFFECT_COUNT);
        good = measure_one(&m, (WrEffect)e, &savings[e], err);
        wr_progress_set(before);
    }
    wr_renderer_free(m.planned.renderer);
    wr_renderer_free(m.forced.renderer);
    return good;
}
