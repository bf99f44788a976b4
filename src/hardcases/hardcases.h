/* hardcases.h - the hard cases of bump mapping: 173 inputs at which a naive program divides by zero, loses
   its digits, reads outside its table or shows a seam; for each what must hold here, and a measurement of
   how far the program's own code is from it, in float and in double.
   Layer 6.

   float    what pictures are made by: the renderer's kernels on strips (of the set asked for and of "ref"),
            its contiguous copies of the table, whole frames; also heights as tables keep them
   double   the formulas themselves: surface/surface.h, shade/bump.h, field/scheme.h, noise/noise.h,
            scene/scene.h

   A measurement is the worst deviation found, in the row's unit, or a count of violations where what must
   hold is no number; the bound then is 0. Nothing here is taken for granted: a row without a comparison
   in a precision says so by NAN ("-"), and one whose effect the program does not have yet waits for it. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;
typedef struct WrText WrText;

#define WR_HARDCASES 173

typedef enum WrHardPrecision { WR_HARD_FLOAT, WR_HARD_DOUBLE, WR_HARD_PRECISIONS } WrHardPrecision;

typedef enum WrHardSubject {
    WR_HARD_GEOMETRY, /* geometry and normals */
    WR_HARD_TABLE,    /* table lookup */
    WR_HARD_NOISE,
    WR_HARD_PAINT,  /* painting, stamping, text */
    WR_HARD_RENDER, /* rendering */
    WR_HARD_SUBJECTS
} WrHardSubject;
extern const char *const wr_hard_subjects[WR_HARD_SUBJECTS]; /* for people */

typedef struct WrHardGauge WrHardGauge; /* private to the room: what measurements write to */

typedef struct WrHardCase {
    const char
        *id; /* "HC01" .. "HC96", then those of later parts; gaps are kept for light and scenes */
    WrHardSubject subject;
    const char *what;                 /* the situation, a few words */
    const char *holds;                /* what must hold, a sentence */
    const char *unit;                 /* of the measurement: "rad", "texels", "violations" */
    double bound[WR_HARD_PRECISIONS]; /* NAN: this precision does not apply */
    /* Measure; NULL: nothing to measure yet. False and an error where something outside the program is
       lacking (an installed font, a place for files). */
    bool (*measure)(WrHardGauge *gauge, WrError *err);
    /* What the program does not have yet; NULL: nothing. With a measure: that part of the case is not
       covered, and the case never passes. */
    const char *waits;
    /* Command lines that build the case for looking at; NULL: there is nothing to be seen. */
    const char *scene;
} WrHardCase;

/* In order: index 0 is HC01, 96 is HC156. */
const WrHardCase *wr_hardcase(int index);
/* The case of that id, or NULL. */
const WrHardCase *wr_hardcase_find(const char *id);

typedef enum WrHardVerdict {
    WR_HARD_PASS,
    WR_HARD_FAIL,
    WR_HARD_WAITS,      /* for an effect that the program does not have */
    WR_HARD_UNMEASURED, /* something outside the program is lacking; note says what */
    WR_HARD_VERDICTS
} WrHardVerdict;
extern const char *const wr_hard_verdicts[WR_HARD_VERDICTS]; /* "pass", "fail", ... */

typedef struct WrHardResult {
    const WrHardCase *row;
    WrHardVerdict verdict;
    double worst[WR_HARD_PRECISIONS];   /* NAN where nothing was compared; INFINITY for a NaN met */
    int64_t checks[WR_HARD_PRECISIONS]; /* comparisons made */
    double seconds;
    char note[256]; /* unmeasured: why */
} WrHardResult;

typedef struct WrHardReport {
    WrHardResult results[WR_HARDCASES];
    int count[WR_HARD_VERDICTS];
    double seconds;
} WrHardReport;

typedef struct WrHardRequest {
    const char *isa; /* kernel set beside "ref"; NULL: the best that this processor has */
    WrPool *pool;    /* borrowed; NULL: one thread */
    const WrProgress *progress; /* may be NULL */
    /* Added to every measured deviation, and turning every other check round where it is not 0: for
       showing that a row can fail. */
    double nudge[WR_HARD_PRECISIONS];
} WrHardRequest;

/* Measure one case. A row passes if it made a comparison in each precision that has a bound, none was
 * beyond it, and no part of it waits. Errors: an isa that does not exist here. The same on any number of threads. */
bool wr_hardcase_run(const WrHardCase *row, const WrHardRequest *request, WrHardResult *out,
                     WrError *err);
/* All of them; a few seconds. Errors: as above, and "cancelled". */
bool wr_hardcases_run(const WrHardRequest *request, WrHardReport *out, WrError *err);

/* The table for a terminal: id, worst in float and in double beside the bound, unit, verdict, what must
 * hold; then a line of counts. */
void wr_hardcases_print(const WrHardReport *report, WrText *text);
/* {"cases":[{"id":"HC01","subject":...,"what":...,"holds":...,"unit":...,"float":{"worst":x,"bound":x,
 * "checks":n},"double":{...},"verdict":"pass","waits":null,"note":null,"seconds":x,"scene":[...]}],
 * "pass":n,"fail":n,"waits":n,"unmeasured":n}. Numbers that are not finite are null; a precision that does
 * not apply is null. */
void wr_hardcases_print_json(const WrHardReport *report, WrText *text);
