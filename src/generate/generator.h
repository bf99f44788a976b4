/* generator.h - things rasterized into a table: patterns, noise, text, solids, terrain, pictures. One const
   table of rows, by which commands, the Generate panel, live preview and tests are made: a new generator is
   one function and one row in its family's table.
   Knows tables, never documents or layers.

   What all of them keep to:
   - They wrap: on a periodic axis the pattern crosses the edge exactly, and the table rolled by whole
     texels is what the same generator gives with its origin moved by as much, bit for bit, wherever the
     mathematics allows; rows that cannot say so in their help.
   - The same bits on every processor and for any number of threads.
   - Heights are finite. Lengths are texels, heights table units, angles degrees anticlockwise as seen. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

#define WR_GENERATOR_PARAMS 28 /* of one generator, at most */
#define WR_GENERATOR_POINTS 4096

typedef enum WrParamKind {
    WR_PARAM_NUMBER,
    WR_PARAM_WHOLE,
    WR_PARAM_CHOICE, /* the value is the word's index */
    WR_PARAM_SWITCH, /* off, on: 0, 1 */
    WR_PARAM_TUPLE,  /* `components` numbers: a place u,v, a vector x,y,z */
    WR_PARAM_POINTS, /* places u,v;u,v;...; none by default */
    WR_PARAM_TERMS, /* tuples of `components` numbers, each within its part's range; one at least */
    WR_PARAM_TEXT,  /* UTF-8; in commands \n stands for a new line (in quotes "\\n") */
    WR_PARAM_FILE   /* of a picture, a font, a mesh; the caller resolves it and knows its hash */
} WrParamKind;

/* One number of a term. */
typedef struct WrParamPart {
    const char *name;
    double low, high; /* closed range */
    bool whole;
} WrParamPart;

typedef struct WrParam {
    const char *name;  /* as in commands; NULL ends the list */
    const char *also;  /* another name that commands accept; NULL: none */
    const char *label; /* for people */
    const char *help;  /* a few words */
    const char *unit;  /* "texels", "degrees", "table units", "" */
    WrParamKind kind;
    double fallback[3];
    const char *fallback_text;  /* texts and files; NULL: it must be given */
    double low, high;           /* closed range of each number */
    double soft_low, soft_high; /* what a slider spans */
    bool above;                 /* `low` itself is excluded */
    bool positional;            /* in commands by place, not by name */
    int components;             /* tuples, terms */
    int fewest;                 /* terms: numbers that may not be left out; the others are then 0 */
    const WrParamPart *parts;   /* terms: [components] */
    const char *shape;          /* tuples, terms: how they are written: "i,j,a;..."; may be NULL */
    const char *const *words;   /* choices; ends with NULL */
} WrParam;

typedef struct WrParamValue {
    double number[3];     /* numbers, choices, switches, tuples */
    const double *points; /* [count][2]; terms: [count][components] */
    int count;
    const char *text; /* texts, files (a path that can be opened); NULL: none */
} WrParamValue;

/* What comes out: heights, and where it says something. */
typedef struct WrNormalMips {
    WrField *heights; /* owned */
    WrField *cover;   /* 0..1, owned; NULL: 1 everywhere */
} WrNormalMips;
void wr_normal_mips_fini(WrNormalMips *relief);

typedef struct WrGenerateJob {
    const WrField
        *like; /* lends size and wrap; its heights are what lies there (erosion reads it) */
    const WrField *selection,
        *mask;                  /* of that size: what is selected, the layer's mask; NULL: none */
    WrPool *pool;               /* NULL: the calling thread */
    const WrProgress *progress; /* NULL: no reports, no cancelling */
    bool coarse;                /* a preview that may be rough where that is much faster */
    void (*note)(void *ctx,
                 const char *text); /* what there is to say besides: dropped octaves, missing
                                                  glyphs, the sign of a normal map; NULL: nobody listens */
    void *note_ctx;
    /* Told of what was chosen where a parameter leaves it open, before it is used, so that the same can be
       asked for again whatever is installed then: the path of a FILE; of a CHOICE another word of it, or
       the path of the file that its word stands for. False, with an error: it must not be used. NULL:
       nobody listens */
    bool (*chose)(void *ctx, const char *param, const char *value, WrError *err);
    void *chose_ctx;
} WrGenerateJob;

typedef struct WrGenerator {
    const char *family; /* the command's verb: "pattern" */
    const char *name;   /* its form: "bricks"; NULL: the family has this one alone */
    const char *label, *help;
    const char *blend;     /* how it joins the layer unless told: "replace", "add", "max" */
    const WrParam *params; /* ends with name NULL */
    /* values: [params], checked against their rows. out: untouched on failure; caller owns it. */
    bool (*make)(const WrParamValue *values, const WrGenerateJob *job, WrNormalMips *out,
                 WrError *err);
} WrGenerator;

typedef struct WrFamily {
    const char *name;  /* the verb */
    const char *label; /* in the panel */
    const char *help;  /* one sentence, for the command's help */
    const char *example;
    const WrGenerator *rows; /* ends with family NULL */
    bool beyond;             /* made of the selection, and not kept to it */
} WrFamily;

/* In the order of the panel; ends with name NULL. A family is one file's table. */
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
/* Checks the values against the row (names what, the value, what would be right), then makes it. */
bool wr_generator_make(const WrGenerator *generator, const WrParamValue *values,
                       const WrGenerateJob *job, WrNormalMips *out, WrError *err);
