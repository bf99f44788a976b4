/* tolerance_contest.h - evaluation of tolerance-driven dials: their error on the whole picture against the reference,
   and their time against the cheapest single setting found by exhaustive search. */
#pragma once
#include "accuracy/ladder.h"
#include "accuracy/tolerance.h"
#include "scene/scene.h"

#include <stdbool.h>

typedef struct WrContestRow {
    WrTolerance tolerance;
    bool claimed;    /* the choice claimed to meet the tolerance */
    double rms, max; /* measured on the whole picture */
    bool held;       /* the measured error is within the tolerance */
    /* the last doubling of samples changed the reference by less than half of the tolerance;
       otherwise `held` is not reliable */
    bool resolved;
    double choosing;    /* seconds for choosing, first picture included */
    double seconds;     /* one more picture with the chosen dials */
    double top_seconds; /* the best setting, measured */
    /* number of pictures from which choosing is faster than the cheapest single setting; 0:
       never */
    int pays_from;
    bool found;                              /* a tested setting meets the tolerance */
    WrSetting cheapest;                      /* the cheapest such setting ... */
    double best_seconds, best_rms, best_max; /* ... its time and its errors */
} WrContestRow;

typedef struct WrContest {
    WrContestRow *rows; /* [count], owned */
    int count;
    int settings; /* schemes x normals x anti-aliasing methods */
    /* Number of tested settings, from cheap to expensive. The others are expected to be slower than the cheapest one
       that meets the finest tolerance, so they cannot win. */
    int tried;
    WrReference reference;
} WrContest;

/* Run on the request's scene (its own tolerance is ignored) with each of the tolerances, of kind rms or max.
   Zero-initialise *out. May test all settings: takes minutes. */
bool wr_contest_run(const WrLadderRequest *request, const WrTolerance *tolerances, int count,
                    WrContest *out, WrError *err);
void wr_contest_fini(WrContest *contest);
/* Print one line for each tolerance; JSON: one object. */
void wr_contest_text(const WrContest *contest, const char *name, WrText *text);
void wr_contest_json(const WrContest *contest, const char *name, WrText *text);
