/* The cheapest place on the ladder for each kind of block. */
#include "accuracy/tolerance_inner.h"

#include "base/clock.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define MARGIN_RMS 0.94 /* of the tolerance: the sample is a small part of the picture */
#define MARGIN_MAX 0.6  /* the worst pixel of all is worse than the worst of the sample */
#define PASS 0.15       /* of the time of one sample a pixel: what one more pass takes */
#define ROUNDS 3        /* of raising what did not hold on the sample */
#define BEST 16         /* samples a side of the best setting */

static const char *const kind_labels[WR_CHOICE_KINDS] = { "empty blocks", "soft edges",
                                                          "edges",        "still inside",
                                                          "calm inside",  "soft relief",
                                                          "relief",       "rough relief" };

/* ---- totals ---- */

/* The study and what it cannot know of: how far each kind's errors are above the prediction. */
typedef struct Weighed {
    const Study *study;
    double weight[WR_CHOICE_KINDS];
} Weighed;

/* The first kind that has blocks and the same place: one pass renders them all. */
static bool begins_pass(const Study *study, const Place places[WR_CHOICE_KINDS], int kind)
{
    for (int k = 1; k < kind; k++)
        if (study->blocks[k] > 0 && wr_same_place(places[k], places[kind])) return false;
    return study->blocks[kind] > 0;
}

static double seconds_of(const Weighed *weighed, const Place places[WR_CHOICE_KINDS])
{
    const Study *study = weighed->study;
    double sum = 0, one = 0;
    int passes = 0;
    for (int k = 1; k < WR_CHOICE_KINDS; k++) {
        if (study->blocks[k] == 0) continue;
        const Place least = { study->scheme_count - 1, study->mode_count - 1, WAY_POINT };
        sum += wr_study_seconds(study, k, places[k]);
        one += wr_study_seconds(study, k, least);
        passes += begins_pass(study, places, k);
    }
    return sum + PASS * one * (passes - 1);
}

static void predict(const Weighed *weighed, int kind, Place place, Measure *out)
{
    wr_study_predict(weighed->study, kind, place, out);
    out->sum[kind] *= weighed->weight[kind];
}

static void predict_all(const Weighed *weighed, const Place places[WR_CHOICE_KINDS], Measure *out)
{
    *out = (Measure){ 0 };
    for (int k = 1; k < WR_CHOICE_KINDS; k++)
        if (weighed->study->blocks[k] > 0) predict(weighed, k, places[k], out);
}

/* Of all kinds, cautiously. */
static double squares_of(const Weighed *weighed, const Place places[WR_CHOICE_KINDS])
{
    Measure all;
    predict_all(weighed, places, &all);
    return wr_study_cautious(weighed->study, &all);
}

/* The same with one kind elsewhere; *all as it stands is left as it was. */
static double squares_with(const Weighed *weighed, const Measure *all, int kind, Place place)
{
    Measure with = *all;
    predict(weighed, kind, place, &with);
    return wr_study_cautious(weighed->study, &with);
}

static double most_at(const Weighed *weighed, int kind, Place place)
{
    Measure at;
    wr_study_predict(weighed->study, kind, place, &at);
    return sqrt(weighed->weight[kind]) * at.most[kind];
}

static double most_of(const Weighed *weighed, const Place places[WR_CHOICE_KINDS])
{
    double most = 0;
    for (int k = 1; k < WR_CHOICE_KINDS; k++)
        if (weighed->study->blocks[k] > 0) most = fmax(most, most_at(weighed, k, places[k]));
    return most;
}

/* ---- what there is to choose from ----

   Every kind has a place of its own; one more pass over the picture is the price of each that differs. */

typedef struct Offer {
    int count;
    Place place[SCHEMES_MAX * MODES_MAX * WAY_COUNT];
} Offer;

/* All places with that scheme and that normal; -1: with any. */
static void list_places(const Study *study, int scheme, int mode, Offer *out)
{
    out->count = 0;
    for (int s = study->scheme_count - 1; s >= 0; s--)
        for (int m = study->mode_count - 1; m >= 0; m--)
            for (int way = 0; way < WAY_COUNT; way++)
                if (study->pair[s][m].tried && study->tried[way] && (scheme < 0 || s == scheme) &&
                    (mode < 0 || m == mode))
                    out->place[out->count++] = (Place){ s, m, way };
}

static void start_cheap(const Weighed *weighed, const Offer *offer, Place places[WR_CHOICE_KINDS])
{
    const Study *study = weighed->study;
    for (int k = 0; k < WR_CHOICE_KINDS; k++) {
        places[k] = offer->place[0];
        for (int i = 1; k > 0 && i < offer->count; i++)
            if (wr_study_seconds(study, k, offer->place[i]) < wr_study_seconds(study, k, places[k]))
                places[k] = offer->place[i];
    }
}

typedef struct Step {
    int kind; /* -1: none */
    Place to;
    double gain; /* squares less for a second more */
} Step;

/* `room`: seconds that a step may add. */
static Step best_step(const Weighed *weighed, const Offer *offer,
                      const Place places[WR_CHOICE_KINDS], double room)
{
    const Study *study = weighed->study;
    Step best = { -1, { 0, 0, 0 }, 0 };
    Measure all;
    predict_all(weighed, places, &all);
    const double squares = wr_study_cautious(study, &all);
    for (int k = 1; k < WR_CHOICE_KINDS; k++) {
        if (study->blocks[k] == 0) continue;
        const double seconds = wr_study_seconds(study, k, places[k]);
        for (int i = 0; i < offer->count; i++) {
            const Place to = offer->place[i];
            const double less = squares - squares_with(weighed, &all, k, to);
            const double more = wr_study_seconds(study, k, to) - seconds;
            if (!(less > 0) || more > room) continue;
            const double gain = more > 0 ? less / more : INFINITY;
            if (gain > best.gain) best = (Step){ k, to, gain };
        }
    }
    return best;
}

/* The last step may have been a large one: take back what the limit does not need. */
static void trim(const Weighed *weighed, const Offer *offer, Place places[WR_CHOICE_KINDS],
                 double limit)
{
    const Study *study = weighed->study;
    for (;;) {
        double best = 0;
        int kind = -1;
        Place to = places[0];
        Measure all;
        predict_all(weighed, places, &all);
        for (int k = 1; k < WR_CHOICE_KINDS; k++)
            for (int i = 0; study->blocks[k] > 0 && i < offer->count; i++) {
                const Place p = offer->place[i];
                const double less =
                    wr_study_seconds(study, k, places[k]) - wr_study_seconds(study, k, p);
                if (less > best && squares_with(weighed, &all, k, p) <= limit)
                    best = less, kind = k, to = p;
            }
        if (kind < 0) return;
        places[kind] = to;
    }
}

/* Root mean square: raise where the gain for the time is best. */
static bool raise_rms(const Weighed *weighed, const Offer *offer, double limit,
                      Place places[WR_CHOICE_KINDS])
{
    while (squares_of(weighed, places) > limit) {
        const Step step = best_step(weighed, offer, places, INFINITY);
        if (step.kind < 0) return false;
        places[step.kind] = step.to;
    }
    trim(weighed, offer, places, limit);
    return true;
}

/* The worst pixel: every kind for itself. The best that there is, and what is cheaper and will do. */
static bool raise_max(const Weighed *weighed, const Offer *offer, double limit,
                      Place places[WR_CHOICE_KINDS])
{
    const Study *study = weighed->study;
    for (int k = 1; k < WR_CHOICE_KINDS; k++) {
        if (study->blocks[k] == 0) continue;
        for (int i = 0; i < offer->count; i++)
            if (offer->place[i].way == study->top) {
                places[k] = offer->place[i]; /* the first: the best scheme and normal */
                break;
            }
        for (int i = 0; i < offer->count; i++)
            if (most_at(weighed, k, offer->place[i]) <= limit &&
                wr_study_seconds(study, k, offer->place[i]) < wr_study_seconds(study, k, places[k]))
                places[k] = offer->place[i];
    }
    return most_of(weighed, places) <= limit;
}

/* A time: the best gains that it buys. */
static void spend(const Weighed *weighed, const Offer *offer, double seconds,
                  Place places[WR_CHOICE_KINDS])
{
    for (;;) {
        const Step step = best_step(weighed, offer, places, seconds - seconds_of(weighed, places));
        if (step.kind < 0) return;
        places[step.kind] = step.to;
    }
}

/* ---- choosing ---- */

static double limit_of(const Study *study, double rms)
{
    return rms * rms * 3 * fmax(study->pixels, 1);
}

/* Is one result better than another: first that it holds, then the time, and for a given time the error. */
typedef struct Result {
    bool holds;
    double seconds, squares;
} Result;

static bool better(const Result *a, const Result *b, bool timed)
{
    if (a->holds != b->holds) return a->holds;
    return timed || !a->holds ? a->squares < b->squares : a->seconds < b->seconds;
}

typedef struct Best {
    bool any;
    Result result;
    Place places[WR_CHOICE_KINDS];
} Best;

static void pick_from(const Weighed *weighed, const Offer *offer, const WrTolerance *tolerance,
                      Best *best)
{
    Place here[WR_CHOICE_KINDS];
    Result result = { 0 };
    const Study *study = weighed->study;
    const bool timed = tolerance->kind == WR_TOLERANCE_TIME;
    start_cheap(weighed, offer, here);
    if (tolerance->kind == WR_TOLERANCE_RMS)
        result.holds =
            raise_rms(weighed, offer, limit_of(study, MARGIN_RMS * tolerance->value), here);
    if (tolerance->kind == WR_TOLERANCE_MAX)
        result.holds = raise_max(weighed, offer, MARGIN_MAX * tolerance->value, here);
    if (timed) spend(weighed, offer, tolerance->value, here);
    result.seconds = seconds_of(weighed, here);
    result.squares = squares_of(weighed, here);
    if (timed) result.holds = result.seconds <= tolerance->value;
    if (best->any && !better(&result, &best->result, timed)) return;
    best->any = true;
    best->result = result;
    memcpy(best->places, here, sizeof here);
}

/* The best places with one scheme and one normal for all kinds, for each pair of those; and from all
   together: what is best step by step need not be best in the end. */
static void pick(const Weighed *weighed, const WrTolerance *tolerance,
                 Place places[WR_CHOICE_KINDS])
{
    const Study *study = weighed->study;
    Best best = { 0 };
    Offer offer;
    for (int scheme = study->scheme_count - 1; scheme >= 0; scheme--)
        for (int mode = study->mode_count - 1; mode >= 0; mode--) {
            list_places(study, scheme, mode, &offer);
            if (offer.count > 0) pick_from(weighed, &offer, tolerance, &best);
        }
    list_places(study, -1, -1, &offer);
    pick_from(weighed, &offer, tolerance, &best);
    memcpy(places, best.places, sizeof best.places);
}

/* How far the sample's own measure is above the prediction: what to reckon with in the next round. */
static void learn(Weighed *weighed, const Place places[WR_CHOICE_KINDS], const Measure *seen)
{
    for (int k = 1; k < WR_CHOICE_KINDS; k++) {
        Measure predicted;
        wr_study_predict(weighed->study, k, places[k], &predicted);
        if (predicted.sum[k] > 0 && seen->sum[k] > weighed->weight[k] * predicted.sum[k])
            weighed->weight[k] = seen->sum[k] / predicted.sum[k];
    }
}

static void judge(const Study *study, const Measure *seen, WrChoice *out)
{
    out->rms = wr_study_rms(study, seen);
    out->max = 0;
    for (int k = 1; k < WR_CHOICE_KINDS; k++)
        if (study->blocks[k] > 0) out->max = fmax(out->max, seen->most[k]);
}

/* margin_rms, margin_max: of the tolerance. */
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

static bool choose(Study *study, const WrTolerance *tolerance, Place places[WR_CHOICE_KINDS],
                   WrChoice *out, WrError *err)
{
    Weighed weighed = { .study = study };
    Measure seen;
    for (int k = 0; k < WR_CHOICE_KINDS; k++) weighed.weight[k] = 1;
    for (int round = 0; round < ROUNDS; round++) {
        pick(&weighed, tolerance, places);
        if (!wr_study_check(study, places, &seen, err)) return false;
        judge(study, &seen, out);
        out->seconds = seconds_of(&weighed, places);
        if (tolerance->kind == WR_TOLERANCE_TIME || holds(tolerance, out, MARGIN_RMS, MARGIN_MAX))
            return true;
        learn(&weighed, places, &seen);
    }
    return true;
}

/* ---- saying it ---- */

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

/* The study's findings become the caller's choice. */
static void settle(Study *study, const Place places[WR_CHOICE_KINDS], WrChoice *out)
{
    const Place top = { study->scheme_count - 1, study->mode_count - 1, study->top };
    const double side = (double)BEST / wr_study_ways[study->top].samples;
    int common = 1; /* empty blocks go with the others */
    for (int k = 2; k < WR_CHOICE_KINDS; k++)
        if (study->blocks[k] > study->blocks[common]) common = k;
    out->kinds = WR_CHOICE_KINDS;
    out->width = study->request->width;
    out->height = study->request->height;
    out->kind_of = wr_alloc((size_t)study->block_count, 1);
    for (int64_t b = 0; b < study->block_count; b++) out->kind_of[b] = study->block[b].kind;
    out->share = (double)study->sample_count / (double)study->block_count;
    for (int k = 0; k < WR_CHOICE_KINDS; k++) {
        out->scenes[k] = wr_study_scene(study, places[k > 0 ? k : common]);
        out->blocks[k] = study->blocks[k];
        if (study->blocks[k] > 0) out->top_seconds += side * side * wr_study_seconds(study, k, top);
    }
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
    Place places[WR_CHOICE_KINDS] = { { 0, 0, 0 } };
    Study study;
    if (tolerance->kind == WR_TOLERANCE_NONE)
        return wr_fail(err, "the scene has no tolerance: set one with `tolerance rms=0.004`");
    bool good = wr_study_begin(&study, renderer, request, fine_of(tolerance), err);
    if (good && study.sample_count > 0) good = choose(&study, tolerance, places, &choice, err);
    if (good) {
        settle(&study, places, &choice);
        choice.spent = wr_clock_seconds() - start;
        choice.met = holds(tolerance, &choice, 1, 1);
        say_reason(tolerance, &choice);
        wr_choice_fini(out);
        *out = choice;
    }
    wr_study_fini(&study);
    return good;
}

void wr_choice_fini(WrChoice *choice)
{
    for (int k = 0; k < choice->kinds; k++) wr_scene_free(choice->scenes[k]);
    wr_free(choice->kind_of);
    *choice = (WrChoice){ 0 };
}

/* ---- using it ---- */

static bool same_dials(const WrScene *a, const WrScene *b)
{
    for (int d = 0; d < WR_DIAL_COUNT; d++)
        if (wr_dials[d].get(a) != wr_dials[d].get(b)) return false;
    return true;
}

/* The first kind with the same setting: one pass renders them all. */
static int first_like(const WrChoice *choice, int kind)
{
    for (int k = 0; k < kind; k++)
        if (choice->blocks[k] > 0 && same_dials(choice->scenes[k], choice->scenes[kind])) return k;
    return kind;
}

bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err)
{
    const int64_t blocks = (int64_t)((choice->width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK) *
                           ((choice->height + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK);
    WrFrame sum = { 0 };
    bool good = true;
    if (request->width != choice->width || request->height != choice->height)
        return wr_fail(err, "the dials were chosen for %dx%d pixels, not %dx%d", choice->width,
                       choice->height, request->width, request->height);
    unsigned char *only = wr_alloc((size_t)blocks, 1);
    int passes = 0;
    for (int k = 0; k < choice->kinds; k++)
        passes += choice->blocks[k] > 0 && first_like(choice, k) == k;
    for (int k = 0; good && k < choice->kinds; k++) {
        if (choice->blocks[k] == 0 || first_like(choice, k) != k) continue;
        WrFrameRequest pass = *request;
        for (int64_t b = 0; b < blocks; b++) only[b] = first_like(choice, choice->kind_of[b]) == k;
        pass.scene = choice->scenes[k];
        pass.dials = NULL;
        pass.only = passes > 1 ? only : NULL; /* larger tiles are faster */
        pass.keep = false;
        pass.hold = passes > 1;
        good = wr_renderer_frame(renderer, &pass, frame, err);
        sum.covered += frame->covered;
        sum.shaded += frame->shaded;
        sum.times.prepare += frame->times.prepare;
        sum.times.visibility += frame->times.visibility;
        sum.times.geometry += frame->times.geometry;
        sum.times.bump += frame->times.bump;
        sum.times.shade += frame->times.shade;
        sum.times.resolve += frame->times.resolve;
        sum.times.total += frame->times.total;
    }
    frame->covered = sum.covered;
    frame->shaded = sum.shaded;
    frame->times = sum.times;
    wr_free(only);
    return good;
}

void wr_choice_print(const WrChoice *choice, WrText *text)
{
    int64_t all = 0;
    for (int k = 0; k < choice->kinds; k++) all += choice->blocks[k];
    for (int k = 1; k < choice->kinds; k++) {
        if (choice->blocks[k] == 0) continue;
        WrText bump = { 0 }, dials = { 0 };
        wr_dials_print(choice->scenes[k], "bump", true, &bump);
        wr_dials_print(choice->scenes[k], "dials", false, &dials);
        wr_text_addf(text, "%s, %.1f %% of the blocks: %s %s\n", kind_labels[k],
                     100.0 * (double)choice->blocks[k] / (double)all, wr_text_get(&bump),
                     wr_text_get(&dials));
        wr_text_fini(&bump);
        wr_text_fini(&dials);
    }
}
