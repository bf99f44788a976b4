/* A tolerance: what keeps to it at the least cost, checked on the sample. */
#include "accuracy/tolerance_inner.h"

#include "base/clock.h"

#include <math.h>

#define MARGIN_RMS 0.95 /* of the tolerance: the sample is a small part of the picture */
#define MARGIN_MAX 0.6  /* the worst pixel of all is worse than the worst of the sample */
#define ROUNDS 5        /* of raising what did not hold on the sample */

/* How far the sample's own measure is above the prediction: what to reckon with in the next round. */
static void learn(Wish *wish, const Error seen[STRATA], const double foretold[STRATA])
{
    for (int s = 1; s < STRATA; s++)
        if (foretold[s] > 0 && seen[s].sum > wish->weight[s] * foretold[s])
            wish->weight[s] = seen[s].sum / foretold[s];
}

static void judge(const Study *study, const Error seen[STRATA], WrChoice *out)
{
    out->rms = wr_study_rms(study, wr_study_cautious(seen));
    out->max = 0;
    for (int s = 1; s < STRATA; s++)
        if (study->all[s] > 0) out->max = fmax(out->max, seen[s].most);
}

/* The margins are parts of the tolerance. */
static bool holds(const WrTolerance *tolerance, const WrChoice *choice, double margin_rms,
                  double margin_max)
{
    switch (tolerance->kind) {
    case WR_TOLERANCE_RMS: return choice->rms <= margin_rms * tolerance->value * 1.0001;
    case WR_TOLERANCE_MAX: return choice->max <= margin_max * tolerance->value * 1.0001;
    case WR_TOLERANCE_TIME: return choice->seconds <= tolerance->value;
    default: return true;
    }
}

static bool choose(Study *study, const WrTolerance *tolerance, Place places[KINDS], WrChoice *out,
                   WrError *err)
{
    Wish wish = { .tolerance = *tolerance, .margin_rms = MARGIN_RMS, .margin_max = MARGIN_MAX };
    for (int s = 0; s < STRATA; s++) wish.weight[s] = 1;
    for (int round = 0; round < ROUNDS; round++) {
        Error seen[STRATA];
        double foretold[STRATA];
        out->seconds = wr_study_pick(study, &wish, places);
        if (!wr_study_check(study, places, seen, foretold, err)) return false;
        judge(study, seen, out);
        if (tolerance->kind == WR_TOLERANCE_TIME || holds(tolerance, out, MARGIN_RMS, MARGIN_MAX))
            return true;
        learn(&wish, seen, foretold);
        /* What looks cheapest is so in part because it was taken for better than it is. */
        if (round > 0 && tolerance->kind == WR_TOLERANCE_RMS)
            wish.margin_rms *= fmin(1, MARGIN_RMS * tolerance->value / out->rms);
    }
    return true;
}

static void say_reason(const WrTolerance *tolerance, WrChoice *out)
{
    static const char *const names[WR_TOLERANCE_COUNT] = { "", "rms", "max", "time" };
    WrText text = { 0 };
    wr_text_addf(&text, "tolerance %s=", names[tolerance->kind]);
    wr_text_add_number(&text, tolerance->value);
    wr_text_addf(&text,
                 "%s: %s; estimated rms %.2g, max %.2g, %.1f ms a frame in place of %.1f; choosing "
                 "took %.1f ms on %.1f %% of the picture",
                 tolerance->kind == WR_TOLERANCE_TIME ? " s" : "",
                 out->met ? "met" : "CANNOT be met by any setting: the nearest was taken", out->rms,
                 out->max, 1e3 * out->seconds, 1e3 * out->top_seconds, 1e3 * out->spent,
                 100 * out->share);
    snprintf(out->reason, sizeof out->reason, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* The RMS error that matters. The worst pixels are far above the mean; for a time nothing is too fine. */
static double fine_of(const WrTolerance *tolerance)
{
    return tolerance->kind == WR_TOLERANCE_RMS   ? tolerance->value
           : tolerance->kind == WR_TOLERANCE_MAX ? 0.03 * tolerance->value
                                                 : 0;
}

bool wr_tolerance_choose(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *out,
                         WrError *err)
{
    const WrTolerance *tolerance = &request->scene->tolerance;
    const double start = wr_clock_seconds();
    WrChoice choice = { 0 };
    Place places[KINDS] = { { 0, 0, 0 } };
    Study study;
    if (tolerance->kind == WR_TOLERANCE_NONE)
        return wr_fail(err, "the scene has no tolerance: set one with `tolerance rms=0.004`");
    bool good = wr_study_begin(&study, renderer, request, fine_of(tolerance), err);
    if (good && study.sample_count > 0) good = choose(&study, tolerance, places, &choice, err);
    if (good) {
        wr_study_settle(&study, places, &choice);
        choice.spent = wr_clock_seconds() - start;
        choice.met = holds(tolerance, &choice, 1, 1);
        say_reason(tolerance, &choice);
        wr_choice_fini(out);
        *out = choice;
    }
    wr_study_fini(&study);
    return good;
}
