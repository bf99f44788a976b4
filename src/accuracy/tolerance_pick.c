/* The cheapest place on the ladder for each kind of block. */
#include "accuracy/tolerance_inner.h"

#include "base/memory.h"

#include <math.h>

#define PLACES (SCHEMES_MAX * MODES_MAX * WAY_COUNT)

/* What a kind takes and is off at a place. */
typedef struct Option {
    double seconds;
    Error error; /* weighed */
} Option;

/* Everything that there is to choose from. */
typedef struct Offer {
    const Study *study;
    const Wish *wish;
    int count;
    Place place[PLACES]; /* the first has the best scheme and normal */
    Option option[KINDS][PLACES];
} Offer;

/* A place for each kind, and what the strata are off with those. */
typedef struct State {
    int at[KINDS];
    Error strata[STRATA];
} State;

static void list_places(Offer *offer)
{
    const Study *study = offer->study;
    for (int s = study->scheme_count - 1; s >= 0; s--)
        for (int m = study->mode_count - 1; m >= 0; m--)
            for (int way = 0; way < WAY_COUNT; way++)
                if (study->pair[s][m].tried && study->tried[way])
                    offer->place[offer->count++] = (Place){ s, m, way };
}

static void fill(Offer *offer)
{
    for (int k = 1; k < KINDS; k++) {
        if (offer->study->blocks[k] == 0) continue;
        const double weight = offer->wish->weight[wr_stratum(k)];
        for (int i = 0; i < offer->count; i++) {
            Option *option = &offer->option[k][i];
            option->seconds = wr_study_seconds(offer->study, k, offer->place[i]);
            option->error = wr_study_predict(offer->study, k, offer->place[i]);
            option->error.sum *= weight;
            option->error.spread *= weight;
            option->error.most *= sqrt(weight);
        }
    }
}

static bool there(const Offer *offer, int kind)
{
    return offer->study->blocks[kind] > 0;
}

static void move(const Offer *offer, State *state, int kind, int to)
{
    Error *stratum = &state->strata[wr_stratum(kind)];
    const Error *from = &offer->option[kind][state->at[kind]].error;
    const Error *next = &offer->option[kind][to].error;
    stratum->sum += next->sum - from->sum;
    stratum->spread += next->spread - from->spread;
    state->at[kind] = to;
}

static void put_all(const Offer *offer, const int at[KINDS], State *state)
{
    *state = (State){ { 0 }, { { 0, 0, 0 } } };
    for (int k = 1; k < KINDS; k++) {
        if (!there(offer, k)) continue;
        state->at[k] = at[k];
        state->strata[wr_stratum(k)].sum += offer->option[k][at[k]].error.sum;
        state->strata[wr_stratum(k)].spread += offer->option[k][at[k]].error.spread;
    }
}

static double seconds_of(const Offer *offer, const State *state)
{
    bool used[PLACES] = { false };
    double sum = 0;
    int passes = 0;
    for (int k = 1; k < KINDS; k++) {
        if (!there(offer, k)) continue;
        sum += offer->option[k][state->at[k]].seconds;
        passes += !used[state->at[k]];
        used[state->at[k]] = true;
    }
    return wr_study_passes(offer->study, sum, passes);
}

static double most_of(const Offer *offer, const State *state)
{
    double most = 0;
    for (int k = 1; k < KINDS; k++)
        if (there(offer, k)) most = fmax(most, offer->option[k][state->at[k]].error.most);
    return most;
}

static bool fits(const Offer *offer, const State *state)
{
    const Wish *wish = offer->wish;
    const double value = wish->tolerance.value;
    switch (wish->tolerance.kind) {
    case WR_TOLERANCE_RMS:
        return wr_study_rms(offer->study, wr_study_cautious(state->strata)) <=
               wish->margin_rms * value;
    case WR_TOLERANCE_MAX: return most_of(offer, state) <= wish->margin_max * value;
    default: return seconds_of(offer, state) <= value;
    }
}

/* ---- step by step ---- */

typedef struct Step {
    int to;      /* -1: none */
    double gain; /* squares less for a second more */
} Step;

static double value_of(const Option *option)
{
    return option->error.sum + option->error.spread;
}

/* The best of what a kind may go to. Sums of kinds add, so one's best step does not depend on the others'. */
static Step best_step(const Offer *offer, int kind, int at)
{
    const Option *here = &offer->option[kind][at];
    Step best = { -1, 0 };
    for (int i = 0; i < offer->count; i++) {
        const Option *next = &offer->option[kind][i];
        const double less = value_of(here) - value_of(next);
        const double more = next->seconds - here->seconds;
        if (!(less > 0)) continue;
        const double gain = more > 0 ? less / more : INFINITY;
        if (gain > best.gain) best = (Step){ i, gain };
    }
    return best;
}

static void start_cheap(const Offer *offer, State *state)
{
    int at[KINDS] = { 0 };
    for (int k = 1; k < KINDS; k++)
        for (int i = 1; there(offer, k) && i < offer->count; i++)
            if (offer->option[k][i].seconds < offer->option[k][at[k]].seconds) at[k] = i;
    put_all(offer, at, state);
}

/* Raise where the gain for the time is best: until it fits, or, for a time, while it does. */
static void raise_sum(const Offer *offer, State *state)
{
    const bool timed = offer->wish->tolerance.kind == WR_TOLERANCE_TIME;
    Step step[KINDS];
    for (int k = 1; k < KINDS; k++)
        step[k] = there(offer, k) ? best_step(offer, k, state->at[k]) : (Step){ -1, 0 };
    while (timed || !fits(offer, state)) {
        int kind = -1;
        for (int k = 1; k < KINDS; k++)
            if (step[k].to >= 0 && (kind < 0 || step[k].gain > step[kind].gain)) kind = k;
        if (kind < 0) return;
        const State before = *state;
        move(offer, state, kind, step[kind].to);
        if (timed && !fits(offer, state)) {
            *state = before;
            step[kind].to = -1;
        } else {
            step[kind] = best_step(offer, kind, state->at[kind]);
        }
    }
}

/* The worst pixel: every kind for itself. The best that there is, and what is cheaper and will do. */
static void raise_most(const Offer *offer, State *state)
{
    const Wish *wish = offer->wish;
    int at[KINDS] = { 0 };
    for (int k = 1; k < KINDS; k++) {
        if (!there(offer, k)) continue;
        while (offer->place[at[k]].way != offer->study->top) at[k]++;
        for (int i = 0; i < offer->count; i++)
            if (offer->option[k][i].error.most <= wish->margin_max * wish->tolerance.value &&
                offer->option[k][i].seconds < offer->option[k][at[k]].seconds)
                at[k] = i;
    }
    put_all(offer, at, state);
}

/* The last step may have been a large one: take back what is not needed. */
static void trim(const Offer *offer, State *state)
{
    for (;;) {
        double best = 0;
        int kind = -1, to = 0;
        for (int k = 1; k < KINDS; k++) {
            if (!there(offer, k)) continue;
            const int at = state->at[k];
            const Option *options = offer->option[k];
            for (int i = 0; i < offer->count; i++) {
                const double less = options[at].seconds - options[i].seconds;
                if (!(less > best)) continue;
                const Error kept = state->strata[wr_stratum(k)];
                move(offer, state, k, i);
                if (fits(offer, state)) best = less, kind = k, to = i;
                move(offer, state, k, at);
                state->strata[wr_stratum(k)] = kept;
            }
        }
        if (kind < 0) return;
        move(offer, state, kind, to);
    }
}

/* Is it the first kind at its place? */
static bool leads(const Offer *offer, const State *state, int kind)
{
    for (int k = 1; k < kind; k++)
        if (there(offer, k) && state->at[k] == state->at[kind]) return false;
    return there(offer, kind);
}

/* Every place that is used is one more pass over the picture: put together what is cheaper together. */
static void put_together(const Offer *offer, State *state)
{
    for (bool again = true; again;) {
        double best = seconds_of(offer, state);
        State found = *state;
        again = false;
        for (int a = 1; a < KINDS; a++)
            for (int b = 1; b < KINDS; b++) {
                const int from = state->at[a], to = state->at[b];
                if (from == to || !leads(offer, state, a) || !leads(offer, state, b)) continue;
                State with = *state;
                for (int k = a; k < KINDS; k++)
                    if (there(offer, k) && with.at[k] == from) move(offer, &with, k, to);
                const double seconds = seconds_of(offer, &with);
                if (seconds < best && fits(offer, &with))
                    found = with, best = seconds, again = true;
            }
        *state = found;
    }
}

/* ---- all of it ---- */

/* Is one better than another: first that it fits, then the time, and for a given time the error; what does not
   fit is better the nearer it comes to that. */
static bool better(const Offer *offer, const State *a, const State *b)
{
    const bool fit = fits(offer, a), timed = offer->wish->tolerance.kind == WR_TOLERANCE_TIME;
    if (fit != fits(offer, b)) return fit;
    if (timed == fit) return wr_study_cautious(a->strata) < wr_study_cautious(b->strata);
    return seconds_of(offer, a) < seconds_of(offer, b);
}

/* Step by step, or one place for all. */
static void choose(const Offer *offer, State *state)
{
    const WrToleranceKind kind = offer->wish->tolerance.kind;
    start_cheap(offer, state);
    if (kind == WR_TOLERANCE_MAX) raise_most(offer, state);
    else raise_sum(offer, state);
    if (kind == WR_TOLERANCE_RMS && fits(offer, state)) trim(offer, state);
    if (kind != WR_TOLERANCE_TIME) put_together(offer, state);
    for (int i = 0; i < offer->count; i++) {
        int at[KINDS];
        State same;
        for (int k = 0; k < KINDS; k++) at[k] = i;
        put_all(offer, at, &same);
        if (better(offer, &same, state)) *state = same;
    }
}

double wr_study_pick(const Study *study, const Wish *wish, Place places[KINDS])
{
    State state;
    Offer *offer = wr_alloc(1, sizeof *offer);
    offer->study = study;
    offer->wish = wish;
    list_places(offer);
    fill(offer);
    choose(offer, &state);
    for (int k = 0; k < KINDS; k++) places[k] = offer->place[state.at[k]];
    const double seconds = seconds_of(offer, &state);
    wr_free(offer);
    return seconds;
}
