#include "render/plan/plan.h"

#include "base/enum_rows.h"

#include <stdio.h>
#include <string.h>

const char *wr_proof_letter(WrProof proof)
{
    WR_ROWS(letters);
    static const char *const letters[] = { [WR_ROW(WR_PROOF_IDENTICAL)] = "I",
                                           [WR_ROW(WR_PROOF_BOUNDED)] = "B",
                                           [WR_ROW(WR_PROOF_POLICY)] = "P" };
    WR_ROWS_END(letters, WR_PROOF_COUNT);
    return letters[proof];
}

/* ---- deciding ---- */

static void decide(WrPlan *plan, WrEffect effect, const WrPlanRequest *ask)
{
    const WrEffectInfo *info = &wr_effects[effect];
    const WrForce force = ask->force ? ask->force[effect] : WR_FORCE_NONE;
    const char *why = "";
    const WrVerdict verdict = info->decide(plan, ask, &why);
    WrPlanRow *row = &plan->rows[effect];
    *row = (WrPlanRow){ .rule = info->rule,
                        .name = info->name,
                        .proof = info->proof,
                        .verdict = verdict,
                        .run = verdict == WR_VERDICT_RUN };
    const bool on = force == WR_FORCE_ON || (ask->full && !info->finer);
    if (verdict == WR_VERDICT_SPARED && on) row->run = true;
    if (force == WR_FORCE_OFF && !info->only_way) row->run = false;
    snprintf(row->reason, sizeof row->reason, "%s%s",
             row->run == (verdict == WR_VERDICT_RUN) ? ""
             : row->run                              ? "forced: "
                                                     : "forced off: ",
             why);
    if (info->settle) info->settle(plan, ask);
}

void wr_plan_build(WrPlan *plan, const WrPlanRequest *ask)
{
    memset(plan, 0, sizeof *plan);
    for (int e = 0; e < WR_EFFECT_COUNT; e++) decide(plan, (WrEffect)e, ask);
}

void wr_plan_samples(WrPlan *plan, const WrPlanRequest *ask)
{
    decide(plan, WR_EFFECT_SAMPLES, ask);
    decide(plan, WR_EFFECT_BOUND, ask);
    decide(plan, WR_EFFECT_DARK, ask); /* depends on the bound */
}

void wr_plan_again(WrPlan *plan, const WrPlanRequest *ask)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        if (wr_effects[e].manner) decide(plan, (WrEffect)e, ask);
}

bool wr_plan_same(const WrPlan *a, const WrPlan *b)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        if (!wr_effects[e].manner && a->rows[e].run != b->rows[e].run) return false;
#define WR_PLAN_DIFFERS(effect, type, name) || a->name != b->name
    return !(false WR_PLAN_SETTINGS(WR_PLAN_DIFFERS));
#undef WR_PLAN_DIFFERS
}

/* ---- costs ---- */

WR_ROWS(wr_cost_names);
const char *const wr_cost_names[WR_COST_COUNT] = {
    [WR_ROW(WR_COST_PREPARE)] = "preparing", [WR_ROW(WR_COST_VISIBILITY)] = "visibility",
    [WR_ROW(WR_COST_GEOMETRY)] = "geometry", [WR_ROW(WR_COST_LIGHT)] = "light",
    [WR_ROW(WR_COST_STORE)] = "storing",     [WR_ROW(WR_COST_CLEAR)] = "clearing",
    [WR_ROW(WR_COST_REST)] = "rest",         [WR_ROW(WR_COST_WAIT)] = "waiting",
    [WR_ROW(WR_COST_CHOOSE)] = "choosing",
};
WR_ROWS_END(wr_cost_names, WR_COST_COUNT);

WR_ROWS(wr_cost_reasons);
const char *const wr_cost_reasons[WR_COST_COUNT] = {
    [WR_ROW(WR_COST_PREPARE)] = "copies of the table, pyramids, the view, the mesh",
    [WR_ROW(WR_COST_VISIBILITY)] = "which samples the object covers",
    [WR_ROW(WR_COST_GEOMETRY)] = "points, tangents and normals of the surface",
    [WR_ROW(WR_COST_LIGHT)] = "diffuse light and highlight of the one light, in one pass",
    [WR_ROW(WR_COST_STORE)] = "colours are put together and stored",
    [WR_ROW(WR_COST_CLEAR)] = "tiles are emptied; those that hold nothing are left out",
    [WR_ROW(WR_COST_REST)] = "what lies between the stages: loops, the clock",
    [WR_ROW(WR_COST_WAIT)] = "threads that found no tile to do",
    [WR_ROW(WR_COST_CHOOSE)] = "estimates of the tolerance, blocks compared and put together",
};
WR_ROWS_END(wr_cost_reasons, WR_COST_COUNT);

/* Cost that a stage's time is added to if none of its effects runs. */
WR_ROWS(stage_costs);
static const WrCost stage_costs[] = {
    [WR_ROW(WR_STAGE_VISIBILITY)] = WR_COST_VISIBILITY,
    [WR_ROW(WR_STAGE_NEWTON)] = WR_COST_VISIBILITY,
    [WR_ROW(WR_STAGE_PARAMETERS)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_GEOMETRY)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_PARALLAX)] = WR_COST_VISIBILITY,
    [WR_ROW(WR_STAGE_CURVATURE)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_FOOTPRINT)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_LOOK)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_PYRAMID)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_NORMALS)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_BUMP)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_SPREAD)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_COLOUR)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_TINT)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_FACETS)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_GRAIN)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_DIFFUSE)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_SPECULAR)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_SURROUND)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_MIRROR)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_SHADOW)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_CAST)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_OCCLUSION)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_LIGHT)] = WR_COST_LIGHT,
    [WR_ROW(WR_STAGE_BOUND)] = WR_COST_REST,
    [WR_ROW(WR_STAGE_HALF)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_RESOLVE)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_STORE)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_CLEAR)] = WR_COST_CLEAR,
    [WR_ROW(WR_STAGE_BETWEEN)] = WR_COST_VISIBILITY,
};
WR_ROWS_END(stage_costs, WR_STAGE_COUNT);

void wr_plan_charge(WrPlan *plan, WrStage stage, double seconds)
{
    double *to = &plan->cost[stage_costs[stage]];
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        if (plan->rows[e].run && (wr_effects[e].stages >> stage & 1)) to = &plan->rows[e].seconds;
    *to += seconds;
}

static void per_pixel(WrPlan *plan)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow *row = &plan->rows[e];
        row->ns_per_pixel = plan->shaded > 0 ? 1e9 * row->seconds / (double)plan->shaded : 0;
    }
}

void wr_plan_add(WrPlan *sum, const WrPlan *more)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow row = more->rows[e];
        const WrPlanRow *before = &sum->rows[e];
        if (!row.run && before->run) row = *before;
        if (row.verdict < before->verdict) row.verdict = before->verdict;
        row.ran = before->ran || more->rows[e].ran;
        row.seconds = before->seconds + more->rows[e].seconds;
        row.tiles = before->tiles + more->rows[e].tiles;
        row.pixels = before->pixels + more->rows[e].pixels;
        sum->rows[e] = row;
    }
    for (int c = 0; c < WR_COST_COUNT; c++) sum->cost[c] += more->cost[c];
    sum->work += more->work;
    sum->shaded += more->shaded;
    per_pixel(sum);
}
