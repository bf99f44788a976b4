/* hardcases.h - table of the hard cases of bump mapping, with measurements of this program's own code. There are
   173 inputs at which a naive program divides by zero, loses digits, reads outside its table or shows a seam.
   Each row states the requirement and measures the program's deviation from it, in float and in double.

   float    the code that renders pictures: the renderer's kernels on strips (of the requested set and of "ref"),
            its contiguous copies of the table, whole frames; also heights as stored in tables
   double   the formulas themselves: surface/surface.h, shade/bump.h, field/scheme.h, noise/noise.h,
            scene/scene.h

   A measurement is the worst deviation found, in the row's unit, or a count of violations if the requirement is
   not numeric; the bound is then 0. Nothing is assumed: a row without a comparison in a precision reports NAN
   ("-"), and a row whose effect the program does not have yet is marked as waiting for it. */
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
    WR_HARD_TABLE,    /* table fetches */
    WR_HARD_NOISE,
    WR_HARD_PAINT,  /* painting, stamping, text */
    WR_HARD_RENDER, /* rendering */
    WR_HARD_SUBJECTS
} WrHardSubject;
extern const char *const wr_hard_subjects[WR_HARD_SUBJECTS]; /* names for display */

typedef struct WrHardMeasurement
    WrHardMeasurement; /* private to the module: output of measurements */

typedef struct WrHardCase {
    /* "HC01" .. "HC96", then those of later parts; gaps are reserved for light and scenes */
    const char *id;
    WrHardSubject subject;
    const char *what;                 /* the situation, in a few words */
    const char *holds;                /* the requirement, one sentence */
    const char *unit;                 /* of the measurement: "rad", "texels", "violations" */
    double bound[WR_HARD_PRECISIONS]; /* NAN: this precision does not apply */
    /* Measurement; NULL: not possible yet. False and an error if something outside the program is missing (an
       installed font, a folder for files). */
    bool (*measure)(WrHardMeasurement *gauge, WrError *err);
    /* Missing feature of the program; NULL: none. With a measurement: that part of the case is not covered, and
       the case never passes. */
    const char *waits;
    /* Command lines that show the case; NULL: it is not visible. */
    const char *scene;
} WrHardCase;

/* In order: index 0 is HC01, 96 is HC156. */
const WrHardCase *wr_hardcase(int index);
/* The case with that id, or NULL. */
const WrHardCase *wr_hardcase_find(const char *id);

typedef enum WrHardVerdict {
    WR_HARD_PASS,
    WR_HARD_FAIL,
    WR_HARD_WAITS,      /* for an effect that the program does not have */
    WR_HARD_UNMEASURED, /* something outside the program is missing; `note` names it */
    WR_HARD_VERDICTS
} WrHardVerdict;
extern const char *const wr_hard_verdicts[WR_HARD_VERDICTS]; /* "pass", "fail", ... */

typedef struct WrHardResult {
    const WrHardCase *row;
    WrHardVerdict verdict;
    double worst[WR_HARD_PRECISIONS];   /* NAN if nothing was compared; INFINITY for a NaN result */
    int64_t checks[WR_HARD_PRECISIONS]; /* number of comparisons */
    double seconds;
    char note[256]; /* unmeasured: the reason */
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
    /* Added to every measured deviation; if not 0, every other check is inverted: for proving that a row can
       fail. */
    double nudge[WR_HARD_PRECISIONS];
} WrHardRequest;

/* Measures one case. A row passes if it made a comparison in each precision that has a bound, none exceeded it,
   and no part of it waits. Errors: an isa that does not exist here. The result is equal for any number of
   threads. */
bool wr_hardcase_run(const WrHardCase *row, const WrHardRequest *request, WrHardResult *out,
                     WrError *err);
/* Measures all cases; a few seconds. Errors: as wr_hardcase_run, and "cancelled". */
bool wr_hardcases_run(const WrHardRequest *request, WrHardReport *out, WrError *err);

/* The table as text: id, worst deviation in float and in double beside the bound, unit, verdict, requirement;
   then a line of counts. */
void wr_hardcases_print(const WrHardReport *report, WrText *text);
/* {"cases":[{"id":"HC01","subject":...,"what":...,"holds":...,"unit":...,"float":{"worst":x,"bound":x,
 * "checks":n},"double":{...},"verdict":"pass","waits":null,"note":null,"seconds":x,"scene":[...]}],
 * "pass":n,"fail":n,"waits":n,"unmeasured":n}. Numbers that are not finite are null; a precision that does
 * not apply is null. */
void wr_hardcases_print_json(const WrHardReport *report, WrText *text);
