/* tolerance_contest.h - is what a tolerance chooses any good? Its error on the whole picture against the reference, its
   time against the cheapest single setting that trying all of them finds.
   Layer 6. */
#pragma once
#include "accuracy/ladder.h"
#include "accuracy/tolerance.h"
#include "scene/scene.h"

#include <stdbool.h>

typedef struct WrContestRow {
    WrTolerance tolerance;
    bool claimed;    /* the choice said that it meets the tolerance */
    double rms, max; /* as measured on the whole picture */
    bool held;       /* the tolerance, by that measure */
    bool
        resolved; /* the reference itself moved by less than half of the tolerance when its samples doubled last:
                      else that says little */
    double choosing;    /* seconds that choosing took, the first picture with it */
    double seconds;     /* of one more such picture, as chosen */
    double top_seconds; /* of the best setting's, measured */
    int pays_from; /* pictures from which on choosing takes less than the cheapest single setting; 0: never */
    bool found;                              /* some setting that was tried meets the tolerance */
    WrSetting cheapest;                      /* the cheapest of them ... */
    double best_seconds, best_rms, best_max; /* ... its time and its errors */
} WrContestRow;

typedef struct WrContest {
    WrContestRow *rows; /* [count], owned */
    int count;
    int settings; /* slopes x normals x ways against aliasing */
    /* Of them, from cheap to dear: the others are expected to take longer than the cheapest that meets the
       finest tolerance, and cannot be the cheapest. */
    int tried;
    WrReference reference;
} WrContest;

/* Run on the request's scene (its own tolerance is not looked at), with each of the tolerances, of kind rms
   or max. Zero-initialise *out. Takes up to the time of all settings: minutes. */
bool wr_contest_run(const WrLadderRequest *request, const WrTolerance *tolerances, int count,
                    WrContest *out, WrError *err);
void wr_contest_fini(WrContest *contest);
/* One line a tolerance; JSON: one object. */
void wr_contest_text(const WrContest *contest, const char *name, WrText *text);
void wr_contest_json(const WrContest *contest, const char *name, WrText *text);
