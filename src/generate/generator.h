/* generator.h - generators of height tables: patterns, noise, text, solids, terrain, pictures. One
   const table of rows.

   Commands, the Generate panel, live preview and tests are generated from the rows: a new generator is
   one function and one row in its family's table. Independent of documents and layers. Common rules:

   - They wrap: on a periodic axis the pattern crosses the edge exactly, and the table rolled by whole
     texels equals the same generator with its origin moved by as much, bit for bit, wherever the
     mathematics allows; the help of other rows states that they do not.
   - The same bits on every processor and for any number of threads.
   - Heights are finite. Lengths are in texels, heights in table units, angles in degrees anticlockwise
     as seen. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

#define WR_GENERATOR_PARAMS 28 /* maximum for one generator */
#define WR_GENERATOR_POINTS 4096

typedef enum WrParamKind {
    WR_PARAM_NUMBER,
    WR_PARAM_WHOLE,
    WR_PARAM_CHOICE, /* the value is the word's index */
    WR_PARAM_SWITCH, /* off, on: 0, 1 */
    WR_PARAM_TUPLE,  /* `components` numbers: a position u,v, a vector x,y,z */
    WR_PARAM_POINTS, /* positions u,v;u,v;...; default: none */
    WR_PARAM_TERMS, /* tuples of `components` numbers, each within its part's range; at least one */
    WR_PARAM_TEXT,  /* UTF-8; in commands \n represents a new line (in quotes "\\n") */
    WR_PARAM_FILE /* a picture, a font, a mesh; the caller resolves the path and stores its hash */
} WrParamKind;

/* One number of a term. */
typedef struct WrParamPart {
    const char *name;
    double low, high; /* closed range */
    bool whole;
} WrParamPart;

typedef struct WrParam {
    const char *name;  /* as in commands; NULL ends the list */
    const char *also;  /* alternative name in commands; NULL: none */
    const char *label; /* for people */
    const char *help;  /* a few words */
    const char *unit;  /* "texels", "degrees", "table units", "" */
    WrParamKind kind;
    double fallback[3];
    const char *fallback_text;  /* texts and files; NULL: required */
    double low, high;           /* closed range of each number */
    double soft_low, soft_high; /* slider range */
    bool above;                 /* `low` itself is excluded */
    bool positional;            /* in commands by position, not by name */
    int components;             /* tuples, terms */
    int fewest;                 /* terms: number of required components; the others default to 0 */
    const WrParamPart *parts;   /* terms: [components] */
    const char *shape;          /* tuples, terms: syntax for help: "i,j,a;..."; may be NULL */
    const char *const *words;   /* choices; ends with NULL */
} WrParam;

typedef struct WrParamValue {
    double number[3];     /* numbers, choices, switches, tuples */
    const double *points; /* [count][2]; terms: [count][components] */
    int count;
    const char *text; /* texts, files (a readable path); NULL: none */
} WrParamValue;

/* Output of a generator: heights and coverage. */
typedef struct WrRelief {
    WrField *heights; /* owned */
    WrField *cover;   /* 0..1, owned; NULL: 1 everywhere */
} WrRelief;
void wr_relief_fini(WrRelief *relief);

typedef struct WrGenerateJob {
    const WrField
        *like; /* defines size and wrap; its heights are the present content (read by erosion) */
    const WrField *selection, *mask; /* of that size: the selection, the layer's mask; NULL: none */
    WrPool *pool;                    /* NULL: the calling thread */
    const WrProgress *progress;      /* NULL: no reports, no cancellation */
    bool coarse; /* a preview that may be less accurate if that is much faster */
    void (*note)(void *ctx,
                 /* receives remarks: dropped octaves, missing glyphs, the sign of a normal map;
                  * NULL: ignored */
                 const char *text);
    void *note_ctx;
    /* Called when an automatic choice was made for a parameter, before it is used, so that a replay
       does not depend on the installed files: the path of a FILE; for a CHOICE another word, or the
       path of its word's file. False, with an error: the choice must not be used. NULL: no callback */
    bool (*chose)(void *ctx, const char *param, const char *value, WrError *err);
    void *chose_ctx;
} WrGenerateJob;

typedef struct WrGenerator {
    const char *family; /* the command's verb: "pattern" */
    const char *name;   /* its form: "bricks"; NULL: the only row of the family */
    const char *label, *help;
    const char *blend;     /* default blend mode on the layer: "replace", "add", "max" */
    const WrParam *params; /* ends with name NULL */
    /* values: [params], already checked. out: unchanged on failure; caller owns it. */
    bool (*make)(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out, WrError *err);
} WrGenerator;

typedef struct WrFamily {
    const char *name;  /* the verb */
    const char *label; /* in the panel */
    const char *help;  /* one sentence, for the command's help */
    const char *example;
    const WrGenerator *rows; /* ends with family NULL */
    bool beyond;             /* derived from the selection, but not limited to it */
} WrFamily;

/* In panel order; ends with name NULL. A family is one file's table. */
extern const WrFamily wr_families[];
extern const WrGenerator wr_patterns[], wr_noise_rows[], wr_text_rows[], wr_solids[], wr_terrains[],
    wr_picture_rows[], wr_formula_rows[], wr_rim_rows[];

const WrFamily *wr_family_find(const char *name);
const WrGenerator *wr_generator_find(const char *family,
                                     const char *name); /* NULL if there is none */
int wr_generator_param_count(const WrGenerator *generator);
int wr_generator_param_find(const WrGenerator *generator, const char *name); /* -1 */
/* All defaults. values: [wr_generator_param_count] */
void wr_generator_defaults(const WrGenerator *generator, WrParamValue *values);
/* Checks the values against the row (errors: parameter, value, valid range), then runs the generator. */
bool wr_generator_make(const WrGenerator *generator, const WrParamValue *values,
                       const WrGenerateJob *job, WrRelief *out, WrError *err);
