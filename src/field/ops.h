/* ops.h - table operations: a table in, a new table out. Blur, median, levels, resize and others, in
   one const table.

   Commands, menus, live preview and tests are generated from the rows: a new operation is one function
   and one row. Common rules:

   - Periodic axes wrap; on a clamped axis the edge texel is repeated outwards.
   - The same bits on every processor and for any number of threads, however the heights are distributed
     over tiles. If texels move only by whole texels, op(roll(F)) is roll(op(F)), bit for bit; except
     noise and warp, which depend on a texel's position, and seamless and match-edges, which change the
     edges.
   - Tiles whose texels are unchanged are shared with the input; NULL tiles stay NULL. (If the table's
     level changes too, as when a constant is added to a table with NULL tiles, these stay NULL at the
     new level, and all others are new.)
   - Filters leave flat neighbourhoods exactly unchanged; noise does not.
   - Heights beyond float's range are clamped to it. Filters are exact as stated while heights are under
     1e37. */
#pragma once
#include "base/enum_rows.h"
#include "field/monotone_curve.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;
typedef struct WrText WrText;

/* Values of resize's `filter`: box is the mean over the area that a texel covers. */
#define WR_RESIZE_FILTERS(X)                                                                       \
    X(WR_RESIZE_BOX, "box")                                                                        \
    X(WR_RESIZE_LINEAR, "linear")                                                                  \
    X(WR_RESIZE_CATMULL, "catmull")                                                                \
    X(WR_RESIZE_LANCZOS3, "lanczos3")
enum { WR_RESIZE_FILTERS(WR_WORD_ID) };

#define WR_OP_PARAMS 6               /* maximum number of parameters of one operation */
#define WR_OP_POINTS WR_CURVE_POINTS /* maximum number of points of a list parameter */
/* maximum number of values of all parameters */
#define WR_OP_VALUES (WR_OP_PARAMS + 2 * WR_OP_POINTS)

typedef struct WrOpParam {
    const char *name;           /* as in commands: "sigma"; NULL ends the list */
    const char *label;          /* for people: "width of the blur" */
    const char *help;           /* a few words */
    const char *unit;           /* "texels", "table units"; "" for plain numbers and words */
    double fallback;            /* the default */
    double low, high;           /* closed range */
    double soft_low, soft_high; /* slider range, within the range */
    bool whole;                 /* whole numbers only */
    bool above;                 /* `low` itself is excluded */
    bool share; /* of integer texels along a side: a number between -1 and 1 is a fraction of that
                   side */
    const char *const
        *choices; /* words, ends with NULL; the value is the word's index. NULL: a number */
    const double
        *points; /* the default of a list of points x,y: their count, then their numbers. Such a
                    parameter is the last of an operation; low and high apply to its numbers. NULL:
                    no list */
} WrOpParam;

/* Optional inputs of an operation besides its table and its parameters. */
typedef struct WrOpOptions {
    const WrField *mask; /* selection, 0..1 (clamped), of the table's size; NULL = everything.
                            result = in + mask (op - in); where it is 0 a texel keeps its bits */
    const WrField *was,  /* previous input of the same operation with the same parameters, */
        *made;    /* and its previous result: only parts that may differ are computed again. Both,
                     of the table's size and without mask; or NULL */
    WrPool *pool; /* NULL: the calling thread only */
    const WrProgress *progress; /* NULL: no reports, no cancellation */
} WrOpOptions;

typedef struct WrOpJob WrOpJob; /* private to the operations */

typedef struct WrOpInfo {
    const char *name;  /* as in commands: "slope-limit"; unique; NULL ends the table */
    const char *label; /* in menus: "Limit slope" */
    const char *help;  /* one sentence */
    bool moves;        /* only moves texels: layers and masks over the table have to move with it */
    bool reshapes;     /* changes the size or the position of the edges: no mask allowed */
    WrField *(*run)(WrOpJob *job, const double *param); /* private: call wr_op_run */
    WrOpParam params[WR_OP_PARAMS + 1];
} WrOpInfo;

extern const WrOpInfo wr_ops[]; /* in menu order; ends with name NULL */
extern const int wr_op_count;

/* The operation of that name, or NULL. */
const WrOpInfo *wr_op_find(const char *name);
/* Number of parameters, 0..WR_OP_PARAMS. */
int wr_op_param_count(const WrOpInfo *op);

/* Runs an operation.
 *
 * in       read only; no writer may run meanwhile
 * param    [wr_op_param_count(op)] in the order of op->params, a list of points as their number and
 *          then the points' numbers; NULL = all defaults
 * options  NULL = whole table, one thread, no reports
 * Returns  a new table, owned by the caller; NULL and an error for a parameter out of range or not
 *          finite, a mask of another size or where none is allowed, no memory for scratch space, or
 *          when cancelled
 * Threads  reports come on the calling thread; pieces of work run on the pool's
 * Memory   a few megabytes per thread; a wide blur allocates one more copy of the table, slope-limit
 *          one or two */
WrField *wr_op_run(const WrOpInfo *op, const WrField *in, const double *param,
                   const WrOpOptions *options, WrError *err);

/* Runs an operation on a table of 0..1, such as a coverage or a mask, and clamps overshoot to that
 * range. The caller owns the result; errors as above. */
WrField *wr_op_run_unit(const WrOpInfo *op, const WrField *in, const double *param,
                        const WrOpOptions *options, WrError *err);

/* An operation with its values, applied again whenever its input changes. */
typedef struct WrFilter {
    const WrOpInfo *op; /* NULL: none */
    double param[WR_OP_VALUES];
} WrFilter;

/* With all values at their defaults. */
WrFilter wr_filter_of(const WrOpInfo *op);
bool wr_filter_same(const WrFilter *a, const WrFilter *b);
/* Checks the values, and that the operation keeps the table's size. */
bool wr_filter_check(const WrFilter *filter, WrError *err);
/* "blur sigma=3": the operation and all its values, in the syntax of `adjust`. */
void wr_filter_print(const WrFilter *filter, WrText *text);
/* Reads and checks printed text; missing values are the defaults. */
bool wr_filter_parse(const char *text, WrFilter *filter, WrError *err);
