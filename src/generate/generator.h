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
#include "base/enum_rows.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

#define WR_GENERATOR_PARAMS 36 /* maximum for one generator */
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
    bool
        path; /* text: SVG path data, sized and placed by `size`, `at` and `rotate` like `picture path`; the
                  window shows its points on the canvas */
    bool layer;               /* text: name of a layer below (WrGenerateJob.layer); "": none */
    int components;           /* tuples, terms */
    int fewest;               /* terms: number of required components; the others default to 0 */
    const WrParamPart *parts; /* terms: [components] */
    const char *shape;        /* tuples, terms: syntax for help: "i,j,a;..."; may be NULL */
    const char *const *words; /* choices; ends with NULL */
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

/* An earlier making with the same values, from other heights. */
typedef struct WrMadeBefore {
    const WrField *heights,
        *cover; /* that it read: of `like`, or of the layer that it names, whose coverage may be NULL */
    uint8_t *
        wanted; /* as in WrGenerateJob; output: cleared where the result is that of before. Set by the caller */
} WrMadeBefore;

typedef struct WrGenerateJob {
    const WrField
        *like; /* defines size and wrap; its heights are the present content (read by erosion) */
    const WrField *selection, *mask; /* of that size: the selection, the layer's mask; NULL: none */
    WrPool *pool;                    /* NULL: the calling thread */
    const WrProgress *progress;      /* NULL: no reports, no cancellation */
    /* [tiles_v][tiles_u] of `like`, from the top: tiles with 0 need not be made, and have any heights. NULL: all are wanted.
     * Generators may make them nevertheless. */
    const uint8_t *wanted;
    const WrMadeBefore *before; /* NULL: none. Only some generators use it */
    bool coarse;                /* a preview that may be less accurate if that is much faster */
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
    /* Finds the layer below of that name: its heights, and coverage (NULL: 1 everywhere), borrowed until the generator
       returns. False, with an error: there is none. NULL: there are no layers */
    bool (*layer)(void *ctx, const char *name, const WrField **heights, const WrField **cover,
                  WrError *err);
    void *layer_ctx;
} WrGenerateJob;

typedef struct WrGenerator {
    const char *family; /* the command's verb: "pattern" */
    const char *name;   /* its form: "bricks"; NULL: the only row of the family */
    const char *label, *help;
    const char *blend;     /* default blend mode on the layer: "replace", "add", "max" */
    const WrParam *params; /* ends with name NULL */
    /* values: [params], already checked. out: unchanged on failure; caller owns it. */
    bool (*make)(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out, WrError *err);
    bool reads; /* it depends on the present heights (WrGenerateJob.like) */
} WrGenerator;

/* A row that does not read the present heights. */
#define WR_GENERATOR(f, n, l, h, b, p, m)                                                          \
    {                                                                                              \
        .family = (f), .name = (n), .label = (l), .help = (h), .blend = (b), .params = (p),        \
        .make = (m)                                                                                \
    }

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

/* Values of the solids' parameter `layout`. */
#define WR_LAYOUTS(X)                                                                              \
    X(WR_LAYOUT_GRID, "grid") X(WR_LAYOUT_HEXAGON, "hexagon") X(WR_LAYOUT_CHANCE, "chance")
enum { WR_LAYOUTS(WR_WORD_ID) };

/* Values of the parameter `of` of edges. */
#define WR_RIM_SOURCES(X)                                                                          \
    X(WR_RIM_AUTO, "auto")                                                                         \
    X(WR_RIM_SELECTION, "selection") X(WR_RIM_MASK, "mask") X(WR_RIM_HEIGHTS, "heights")
enum { WR_RIM_SOURCES(WR_WORD_ID) };

/* The layer that a text with the flag `layer` names. */
bool wr_generate_layer(const WrGenerateJob *job, const char *name, const WrField **heights,
                       const WrField **cover, WrError *err);

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

/* ---- macros for parameter rows ---- */

/* Common parameters of generators, as macros for their tables. */
#define WR_P_NUMBER(n, l, value, lowest, highest, soft, u, h)                                      \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = (u), .kind = WR_PARAM_NUMBER,              \
        .fallback = { value }, .low = (lowest), .high = (highest),                                 \
        .soft_low = (lowest) < -1e6 ? -(soft) : (lowest), .soft_high = (soft)                      \
    }
#define WR_P_ABOVE(n, l, value, lowest, highest, soft, u, h)                                       \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = (u), .kind = WR_PARAM_NUMBER,              \
        .fallback = { value }, .low = (lowest), .above = true, .high = (highest),                  \
        .soft_low = (lowest), .soft_high = (soft)                                                  \
    }
#define WR_P_LAYER(h)                                                                              \
    {                                                                                              \
        .name = "layer", .label = "Layer", .help = (h), .unit = "", .kind = WR_PARAM_TEXT,         \
        .fallback_text = "", .layer = true                                                         \
    }
#define WR_P_WHOLE(n, l, value, lowest, highest, soft, h)                                          \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "", .kind = WR_PARAM_WHOLE,                \
        .fallback = { value }, .low = (lowest), .high = (highest),                                 \
        .soft_low = (lowest) < 0 ? -(soft) : (lowest), .soft_high = (soft)                         \
    }
#define WR_P_CHOICE(n, l, value, list, h)                                                          \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "", .kind = WR_PARAM_CHOICE,               \
        .fallback = { value }, .words = (list)                                                     \
    }
#define WR_P_SWITCH(n, l, value, h)                                                                \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "", .kind = WR_PARAM_SWITCH,               \
        .fallback = { value }, .high = 1                                                           \
    }
#define WR_P_PART(n, l, value, h) WR_P_NUMBER(n, l, value, 0, 1, 1, "", h)
#define WR_P_TEXELS(n, l, value, soft, h) WR_P_NUMBER(n, l, value, 0, 16384, soft, "texels", h)

#define WR_P_HEIGHT                                                                                \
    WR_P_NUMBER("height", "Height", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",        \
                "height from the lowest to the highest place; below 0 inverts the relief")
/* For tilted and rough pieces, which rise above a plain one. */
#define WR_P_PIECE_HEIGHT                                                                          \
    WR_P_NUMBER("height", "Height", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",        \
                "height of a level piece above the ground; tilted and rough ones rise above it, "  \
                "by up to tilt plus half of rough (shares of height); below 0 inverts the relief")
#define WR_P_SEED WR_P_WHOLE("seed", "Seed", 1, 0, 4294967295.0, 999, "seed of the random numbers")
#define WR_P_ORIGIN                                                                                \
    {                                                                                              \
        .name = "origin", .also = "at", .label = "Origin", .help = "position of its corner",       \
        .unit = "", .kind = WR_PARAM_TUPLE, .low = -1e6, .high = 1e6, .soft_low = 0,               \
        .soft_high = 1, .shape = "u,v", .components = 2                                            \
    }
#define WR_P_END                                                                                   \
    {                                                                                              \
        .name = NULL                                                                               \
    }

#define WR_PARAM_HEIGHT 1e30 /* maximum height, table units */

/* A row's values. */
typedef struct WrParams {
    const WrParam *params;      /* ends with name NULL */
    const WrParamValue *values; /* one for each parameter */
} WrParams;

/* The value of an existing parameter: a number, a choice's index, a switch. */
double wr_param_number(const WrParams *params, const char *name);
int wr_param_whole(const WrParams *params, const char *name);
/* The whole value. */
const WrParamValue *wr_param_value(const WrParams *params, const char *name);
/* An integer, 0..2^32 - 1. */
uint32_t wr_param_seed(const WrParams *params);

/* Texel positions in a pattern whose origin is moved: texel i is at ((i - shift) mod size + 1/2 - rest)
   / size of it, so that a move by whole texels is a roll, bit for bit. */
typedef struct WrOrigin {
    int size, shift; /* 0 <= shift < size */
    double rest;     /* of a texel, -0.5..0.5 */
} WrOrigin;

/* origin: in cells, from the left for u; for v from below, so pass -origin for rows. */
WrOrigin wr_origin(int size, double origin);

/* The texel's distance from the origin in texels, in [0, size). */
static inline double wr_origin_at(const WrOrigin *origin, int i)
{
    int k = i - origin->shift;
    double x = (k < 0 ? k + origin->size : k) + 0.5 - origin->rest;
    return x < 0.0 ? x + origin->size : x >= origin->size ? x - origin->size : x;
}
