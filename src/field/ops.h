/* ops.h - table operations: a table in, a new table out. Blur, median, levels, resize and the like, in
   one const table of rows, by which commands, menus, live preview and tests are made: a new operation is
   one function and one row.

   What all of them keep to:
   - Periodic axes wrap; on a clamped axis the edge texel is repeated outwards.
   - The same bits on every processor and for any number of threads, whatever tiles the heights are kept
     in. Where no texel's place changes by other than whole texels, op(roll(F)) is roll(op(F)), bit for bit; but
     for noise and warp, which go by a texel's place.
   - Tiles whose texels come out equal are the very tiles of the input; those that are NULL stay NULL.
     (Where the table's level changes with them, as when a constant is added to a table that has NULL
     tiles, these stay NULL at the new level, and all others are new.)
   - Filters leave flat neighbourhoods exactly as they are; noise does not.
   - Heights that would pass float's range are clamped to it. Filters are exact as stated while heights
     are under 1e37. */
#pragma once
#include "base/enum_rows.h"
#include "field/monotone_curve.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;
typedef struct WrText WrText;

/* What `filter` of resize may be: box is the mean of what a texel covers. */
#define WR_RESIZE_FILTERS(X)                                                                       \
    X(WR_RESIZE_BOX, "box")                                                                        \
    X(WR_RESIZE_LINEAR, "linear")                                                                  \
    X(WR_RESIZE_CATMULL, "catmull")                                                                \
    X(WR_RESIZE_LANCZOS3, "lanczos3")
enum { WR_RESIZE_FILTERS(WR_WORD_ID) };

#define WR_OP_PARAMS 6               /* parameters of one operation, at most */
#define WR_OP_POINTS WR_CURVE_POINTS /* points of one that is a list of points, at most */
#define WR_OP_VALUES (WR_OP_PARAMS + 2 * WR_OP_POINTS) /* the numbers of all of them, at most */

typedef struct WrOpParam {
    const char *name;           /* as in commands: "sigma"; NULL ends the list */
    const char *label;          /* for people: "width of the blur" */
    const char *help;           /* a few words */
    const char *unit;           /* "texels", "table units"; "" for plain numbers and words */
    double fallback;            /* the default */
    double low, high;           /* closed range */
    double soft_low, soft_high; /* what a slider spans, within the range */
    bool whole;                 /* whole numbers only */
    bool above;                 /* `low` itself is excluded */
    bool
        share; /* of whole texels along a side: a number between -1 and 1 is a share of that side */
    const char *const
        *choices; /* words, ends with NULL; the value is the word's index. NULL: a number */
    const double
        *points; /* the default of a list of points x,y: their number, then theirs. Such a parameter
                             is the last of an operation; low and high are of its numbers. NULL: no list */
} WrOpParam;

/* What an operation may be given besides its table and its parameters. */
typedef struct WrOpOptions {
    const WrField *mask; /* selection, 0..1 (clamped), of the table's size; NULL = everything.
                            result = in + mask (op - in); where it is 0 a texel keeps its bits */
    const WrField *was,  /* what the same operation with the same parameters was given before, */
        *made;    /* and what it made of that: only what may differ is done again. Both, of the
                            table's size and without mask; or NULL */
    WrPool *pool; /* NULL: the calling thread alone */
    const WrProgress *progress; /* NULL: no reports, no cancelling */
} WrOpOptions;

typedef struct WrOpJob WrOpJob; /* private to the operations */

typedef struct WrOpInfo {
    const char *name;  /* as in commands: "slope-limit"; unique; NULL ends the table */
    const char *label; /* in menus: "Limit slope" */
    const char *help;  /* one sentence */
    bool moves;        /* only moves texels: what lies over a table has to move with it */
    bool reshapes;     /* gives another size or another place for the edges: takes no mask */
    WrField *(*run)(WrOpJob *job, const double *param); /* private: call wr_op_run */
    WrOpParam params[WR_OP_PARAMS + 1];
} WrOpInfo;

extern const WrOpInfo wr_ops[]; /* in the order of menus; ends with name NULL */
extern const int wr_op_count;

/* The operation of that name, or NULL. */
const WrOpInfo *wr_op_find(const char *name);
/* How many parameters it has, 0..WR_OP_PARAMS. */
int wr_op_param_count(const WrOpInfo *op);

/* Carry out an operation.
 *
 * in       read only; no writer may run meanwhile
 * param    [wr_op_param_count(op)] in the order of op->params, a list of points as their number and then
 *          the points' numbers; NULL = all defaults
 * options  NULL = whole table, one thread, no reports
 * Returns  a new table, the caller's; NULL and an error for a parameter out of its range or not finite, a
 *          mask of another size or where none is taken, no memory for scratch space, or when cancelled
 * Threads  reports come on the calling thread; pieces of work run on the pool's
 * Memory   a few megabytes a thread; a wide blur holds one more copy of the table, slope-limit one or
 *          two */
WrField *wr_op_run(const WrOpInfo *op, const WrField *in, const double *param,
                   const WrOpOptions *options, WrError *err);

/* The same of a table of 0..1, such as a coverage or a mask, which stays within that whatever the operation overshoots.
 * What is returned is the caller's, errors are as above. */
WrField *wr_op_run_unit(const WrOpInfo *op, const WrField *in, const double *param,
                        const WrOpOptions *options, WrError *err);

/* An operation with its values, which is carried out again whenever what lies below it changes. */
typedef struct WrFilter {
    const WrOpInfo *op; /* NULL: none */
    double param[WR_OP_VALUES];
} WrFilter;

/* With all values at their defaults. */
WrFilter wr_filter_of(const WrOpInfo *op);
bool wr_filter_same(const WrFilter *a, const WrFilter *b);
/* Check that it may stand over a table: that it keeps the table's size, and its values. */
bool wr_filter_check(const WrFilter *filter, WrError *err);
/* "blur sigma=3": the operation and all its values, as `adjust` takes them. */
void wr_filter_print(const WrFilter *filter, WrText *text);
/* Read what was printed and check it; values that are not there are the defaults. */
bool wr_filter_parse(const char *text, WrFilter *filter, WrError *err);
