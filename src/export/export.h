/* export.h - export of the height table to files for other programs: heights, normal maps and further maps of
   the unit cell. Each kind is one row of wr_export_kinds; a new kind is one function and one row.

   The cell is exported as painted: without replication, surface and camera. Row 0 of a file is the top row of
   the table. If the scene has an analytic F, the formula is sampled at the texels' centres instead of the table,
   at the table's size. object= exports the table of one of the scene's objects instead: its layer or its
   formula, and its scheme. Files are replaced atomically (base/file.h): on any failure the target is unchanged.
   The bytes are equal for any number of threads.

   height, integer codes 0..M, M = 255 or 65535 (never 256 or 65536):
   The range goes into the label (wrinkle:range), which `image` and opening read back (document/label.h).
     range lo,hi   code = round(M (F - lo) / (hi - lo)), clamped to 0..M; back: F = lo + code/M (hi - lo)
     range auto    lo, hi = the smallest and largest F; a flat table is code 0, with hi above lo
     range signed  code = Z + round((Z - 1) F / A), A = max |F|, Z = 128 or 32768: so 0 is exact
   height, float: the heights themselves, unchanged, one channel Y; range is ignored.

   normal+y, normal-y: at each texel's centre
     n = normalise(-height dF/dU / cell_w, -height dF/dV / cell_h, 1)
   (in millimetres, if the document states the cell's size in them, with its height; else in scene units) with
   dF/dU, dF/dV the scheme's derivatives of the table over the unit cell, V up. normal-y negates the second
   component. In a +Y map the upper flank of a bump is bright green. Codes are round(M (n/2 + 1/2)); float files
   contain n/2 + 1/2.

   axes=+x-z+y selects the components and signs of red, green and blue; opengl and directx are +x+y+z and +x-y+z;
   strength= multiplies the slopes, which are true to scale at 1. normal-object: the unit normal of the scene's
   surface bent by bump (shade/bump.h), along the object's axes, at (u,v) of the texel's centre. normal-baked:
   for a mesh, in the frames of MikkTSpace, with padding around its islands (baked.c).

   slopes, two channels of floats: p = height dF/dU / cell_w, q = height dF/dV / cell_h, V up, with the scheme's
   derivatives at each texel's centre. slope: atan sqrt(p^2 + q^2), 0 to 90 degrees as 0..M; float files contain
   degrees.

   curvature: minus the mean curvature of the relief over the cell, so that ridges are bright and grooves dark,
     H = ((1 + q^2) r - 2 p q s + (1 + p^2) t) / (2 (1 + p^2 + q^2)^(3/2)),   bumps have H < 0
   with r, s, t the means of the second derivatives over a texel, that is differences of p and q across it. Codes
   are Z + round((Z - 1) (-H) / full), Z = 128 or 32768, clamped: 0 is exact; float files contain -H, 1 / scene
   unit.

   curvature part=convex, concave: max(0, -H), max(0, H), from 0, which is code 0, to the largest or `full`.

   occlusion, horizon, cavity, direction, roughness: field/maps.h and field/occlusion.h define a texel's value.
   Codes 0..M are
     occlusion, roughness  0 to 1          direction  0 to 360 degrees
     horizon               slopes 0 to the largest, in one direction; all directions, a channel each, are floats
     cavity                -full to 0: white is outside cavities, black as deep as the deepest
   displacement: scale (F - ground), with ground 0, the lowest or a given height; coded like heights. mask: 1
   from low to high, falling to 0 over `feather` beyond either end; sharp if that is 0. wear: of edges. With c =
   convex curvature divided by `full` (default: exceeded by one texel in 50), at most 1, and N periodic noise of
   -1..1 with `grain` cells,
     max(0, min(1, (c (1 + noise N) - threshold) / (1 - threshold))).
   packed: several of these in one picture, one per channel, 0..1 of their code range; curvature is 1/2 where it
   is 0. All except wear with noise are shifted exactly, to the bit, if the table is shifted.

   bump-slopes: six channels of floats, h, dh/ds, dh/dt, their squares and product, h in table units, s to the
   right and t DOWN, per texel, or over the cell and divided by uvslopes=; in a tiled EXR with mip levels, each
   the means of the texels it covers, with the channel names of OpenImageIO's maketx --bumpslopes.
   signs=renderman negates both slopes.

   contact: maps as thumbnails in one picture, each with its name.

   lines: a 3D line drawing of the cell with its hidden lines removed, the paper's figure 5, black on white;
   vectors if the extension is svg or pdf, else a picture of 8 bits. profile: F along a line of the cell as a
   chart, by the scheme's interpolation.

   stl, ply, obj: the relief on its surface (replicated, stretched as the object is) as a closed body of
   triangles in millimetres: open sheets get a back, tubes are filled or get a wall. Decimated: no sample of the
   table is farther from its triangle than the requested error, and the report contains the largest distance. */
#pragma once
#include "base/enum_rows.h"
#include "field/seam_check.h"
#include "surface/mesh_faults.h"
#include "surface/triangles.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrText WrText;

typedef enum WrExportRange {
    WR_EXPORT_RANGE_GIVEN,
    WR_EXPORT_RANGE_AUTO,
    WR_EXPORT_RANGE_SIGNED
} WrExportRange;

/* The JSON file beside a written file that describes it. Left out: only of files of numbers (.raw, .r16, .r32). */
typedef enum WrExportSidecar {
    WR_EXPORT_SIDECAR_LEFT_OUT,
    WR_EXPORT_SIDECAR_ON,
    WR_EXPORT_SIDECAR_OFF
} WrExportSidecar;

typedef enum WrExportPart { WR_EXPORT_BOTH, WR_EXPORT_CONVEX, WR_EXPORT_CONCAVE } WrExportPart;

typedef enum WrExportGround {
    WR_EXPORT_GROUND_ZERO,
    WR_EXPORT_GROUND_LOWEST,
    WR_EXPORT_GROUND_GIVEN
} WrExportGround;

/* Content of a channel of a packed picture. */
typedef struct WrExportPack {
    int filling; /* 0: default; a map of channel_packing.c, counted from 1; or NUMBER */
    double number;
} WrExportPack;
#define WR_PACK_NUMBER (-1)

/* Arrangement of the cell: export's option lay=. */
#define WR_LAY_LIST(X)                                                                             \
    X(WR_LAY_PLAIN, "plain")                                                                       \
    X(WR_LAY_HALF_DROP, "half-drop")                                                               \
    X(WR_LAY_BRICK, "brick")                                                                       \
    X(WR_LAY_HEX, "hex")
typedef enum WrExportLay { WR_LAY_LIST(WR_WORD_ID) WR_LAYS } WrExportLay;
extern const char *const wr_lay_names[]; /* ends with NULL */

typedef struct WrExportOptions {
    int depth; /* bits per channel: 8, 16, 32 (float); 0 = the largest that the format supports */
    WrExportRange range;   /* integer heights only; only `given` clips */
    double low, high;      /* range given: F of code 0 and of the last code, low < high */
    double amplitude;      /* range signed: the height of the last code; 0: the largest |F| */
    double cell_w, cell_h; /* size of the unit cell in scene units; 0: the scene's */
    /* normals: components of red, green and blue: 1 x, 2 y, 3 z, negative: inverted; all 0: the kind's default */
    int axes[3];
    int padding;      /* baked normals: rings of texels around the covered ones, 0..64 */
    int map_w, map_h; /* maps of a surface or a mesh: texels, 1..WR_FIELD_MAX; 0: the table's */
    double strength;  /* normals: factor of the slopes, finite, not 0 */
    int scheme;       /* normals: a WrScheme, or -1 for the scene's */
    const char *
        object; /* object to export; borrowed; NULL: the composite, with scheme and formula of the current object */
    double full; /* curvature: value of white, 1 / scene unit; 0: the largest */
    /* Maps computed from the whole table: */
    int directions; /* occlusion, horizon: 4, 8, 16, 32 */
    int reach;      /* occlusion, horizon: texels; 0: unlimited */
    double toward;  /* horizon: degrees; below 0: all directions, a channel each */
    double radius;  /* cavity: standard deviation of the blur, texels */
    int part;       /* curvature: a WrExportPart */
    int box;        /* roughness: texels, odd */
    double base;    /* roughness: Beckmann's alpha of the material, 0..1; below 0: the scene's */
    WrExportPack pack[4]; /* packed: red, green, blue, alpha */
    WrExportGround ground;
    double ground_at;           /* displacement: the ground's height, if given, table units */
    double scale;               /* displacement: of F = 1; NAN: the scene's height */
    double mask_low, mask_high; /* mask: NAN: the middle of the range; no limit */
    double feather;             /* mask: table units, >= 0 */
    double threshold;           /* wear: 0 to below 1 */
    double noise;               /* wear: 0..1 */
    int grain;                  /* wear: cells of the noise across the table */
    bool dither; /* depth 8 only: ordered dither of up to half a code in either direction */
    bool half;   /* 16-bit floats, EXR only: requested by depth 16 there, and depth is then 32 */
    /* sheets: the table is arranged, repeated, resized, combined with others, in this order */
    WrExportLay lay;
    int repeat_u, repeat_v; /* 0 or 1: once */
    int resize_w, resize_h; /* texels; 0: unchanged, -1: the nearest powers of two */
    int filter;             /* of resize, WR_RESIZE_... (field/ops.h) */
    const char *atlas;      /* "A;B": files of further cells; borrowed; NULL: no atlas */
    int margin;             /* texels around each cell of an atlas */
    /* heights, normals, slopes: one more sample along each axis, at i/n by the scheme; on a periodic axis the
       last equals the first */
    bool border;
    bool mips;                /* also writes files of half the size, a quarter and so on */
    bool big;                 /* raw files only: big-endian */
    int sidecar;              /* a WrExportSidecar: is a description file written beside it? */
    bool renderman;           /* bump slopes: negates the slopes */
    double uvslopes;          /* bump slopes: slopes over the cell, divided by this; 0: per texel */
    const char *contact_maps; /* contact: "A;B", kinds; borrowed; NULL: all kinds of the cell */
    int contact_tile;         /* pixels of each thumbnail */
    /* lines: */
    /* number of lines along u and along v: 0..1024, not both 0; at most one per texel */
    int lines_u, lines_v;
    double turn_deg, tilt_deg; /* rotation about the vertical; angle above the horizon, 0..90 */
    double relief; /* height of F = 1 in cells; 0: the whole relief is a fifth of a cell high */
    int drawing_w, drawing_h; /* pixels, 16..4096 */
    double pen;               /* line width, pixels, 0.1..20 */
    bool hidden;              /* hidden lines are drawn as well */
    /* profile; drawing size and pen as for lines: */
    bool along_v; /* along v, else along u */
    double at;    /* the other coordinate, 0..1 */
    int grid;     /* divisions of the line, 1..256 */
    /* stl, ply, obj, 3mf, in millimetres: */
    /* longest side of the surface without its relief; 0: for a plane the document's cell, if it is in
       millimetres, for a mesh its own unit, else 100 */
    double solid_size;
    double solid_error;     /* largest error of a sample, > 0 */
    int32_t solid_most;     /* triangles of the relief at most, without its back */
    double solid_thickness; /* below the lowest sample; 0: 2 for a sheet, a tube is filled */
    bool solid_rounded; /* of a mesh: its hard edges become round under relief, else stay sharp */
    bool solid_limited; /* of a mesh: relief that folds over is lowered */
} WrExportOptions;

#define WR_EXPORT_OBJECT_NAME 64

/* Results of an export, for the user. */
typedef struct WrExportReport {
    int width, height, channels, depth;
    bool half;        /* with depth 32: 16-bit floats */
    int64_t clipped;  /* texels outside the range */
    int64_t replaced; /* texels with non-finite F or normal, replaced by 0 (or straight up) */
    double low, high; /* smallest and largest F, table units */
    bool ranged;      /* integer heights: the next four are valid */
    double code_low, code_high; /* F of code 0 and of the last code */
    int zero_code;          /* the code of F = 0 if it is exact by construction (signed), else -1 */
    double amplitude;       /* signed: A */
    const char *quantity;   /* quantity of low and high: "curvature"; NULL: heights */
    const char *convention; /* normals: "+Y (green up)"; else NULL */
    /* Result of reading the written file back. `seen` is false if nothing could be compared: drawings and
       bodies, whose bytes are compared, and `unseen` for pictures whose texels were only hashed, because a limit
       on file sizes leaves no space for rows. */
    bool seen, unseen;
    /* continuity of the cell's edges, by the scheme of the export, else the scene's */
    WrCertificate seam;
    double worst;  /* largest error: table units, or the quantity's; for normals degrees */
    int64_t lines; /* drawings: number of visible line segments; else 0 */
    /* Solids, in millimetres; triangles 0: none */
    int64_t triangles;
    double solid_error;   /* largest distance of a sample of the table */
    double solid_size[3]; /* of the body, including relief and back */
    double solid_volume;  /* mm3; 0 of an open mesh */
    /* of a mesh: */
    bool solid_open;      /* as the mesh is */
    int64_t solid_folds;  /* triangles that the relief turned over ... */
    double solid_fold[3]; /* ... and the place of the highest, mm */
    int64_t solid_missed; /* triangles too small to bisect whose error is larger than requested */
    int64_t solid_thin;   /* points where the relief is deeper than half the wall, or gap, ... */
    double solid_thinnest[3]; /* ... and the place of the worst, mm */
    int64_t solid_limited;    /* points at which the relief was lowered */
    int64_t
        solid_steps; /* triangles at hard edges and seams of (u,v) that span a step of the relief */
    WrMeshFaults solid_faults; /* of the mesh without relief */
    double solid_left_out[3];  /* mm: place of the mesh in its file that the solid does not have */
    double solid_relief;       /* mm from the lowest to the highest F, of all solids ... */
    double solid_allowed;      /* ... and the requested error */
    /* maps of a mesh: */
    WrUvOverlap overlap; /* of its (u,v) */
    bool table_sized;    /* the map's size is the table's */
    /* which object a solid, a model or a map of a surface is of, from 1, and the number of objects, if there are
       several; else 0 */
    int object, objects;
    char object_name[WR_EXPORT_OBJECT_NAME]; /* cut; may be empty */
    bool model;                              /* a model, without the three above */
    int pictures;                            /* in the model */
} WrExportReport;

typedef struct WrExportOptionInfo {
    const char *name;   /* name in commands: "range" */
    const char *values; /* allowed values for help texts: "LOW,HIGH, auto or signed" */
    const char *help;   /* one sentence, with the default */
    bool (*set)(WrExportOptions *options, const char *value,
                WrError *err); /* internal: use wr_export_option */
    bool named;                /* its value is the name of an object of the document */
} WrExportOptionInfo;

#define WR_EXPORT_OPTIONS 20 /* maximum options of a kind */

#define WR_EXPORT_CHANNELS 32 /* maximum */
#define WR_EXPORT_NAME 16     /* bytes of a channel's name */

typedef struct WrExportJob WrExportJob; /* private to the module */

/* Input of a material that a map can be (material_files.h). */
typedef enum WrMaterialRole {
    WR_ROLE_NONE,
    WR_ROLE_NORMAL,
    WR_ROLE_HEIGHT,
    WR_ROLE_ROUGHNESS,
    WR_ROLE_METALNESS,
    WR_ROLE_OCCLUSION,
    WR_ROLE_COLOUR,
    WR_ROLES,
    WR_ROLE_CHANNELS = WR_ROLES /* a role for each channel (channel_packing.h) */
} WrMaterialRole;

typedef struct WrExportKind {
    const char *name, *label, *help;
    WrExportOptionInfo options[WR_EXPORT_OPTIONS + 1]; /* a NULL name ends the list */
    int channels;                                      /* of a picture; 0 for a model */
    bool solid;  /* the relief as triangles, with the options `size`, `error` and so on of solids */
    bool floats; /* requires floats instead of codes */
    bool levels; /* has mip levels (mip_files.h) */
    const char *const *channel_names; /* [channels]; NULL: the default ones */
    double green;                     /* normals: sign of the second component */
    WrMaterialRole role;
    bool table_units;   /* the numbers are heights of the table; else final values of the role */
    bool on_surface;    /* it covers the scene's surface, in scene units, instead of the cell */
    const char *ending; /* required extension of its files; NULL: that of a picture or a drawing */
    /* Number of channels as a function of the options; NULL: `channels`, with default names. names: output
       [WR_EXPORT_CHANNELS][WR_EXPORT_NAME] */
    int (*count_channels)(const WrExportJob *job, char (*names)[WR_EXPORT_NAME]);
    /* Computes the whole map first, for kinds that need all of the table; `rows` then only stores it. May be
       NULL. */
    bool (*make)(WrExportJob *job, WrError *err);
    /* Computes values of the whole table needed before the first row (ranges). May be NULL. */
    void (*prepare)(WrExportJob *job);
    /* Writes the whole file itself, instead of the following functions: drawings. The job's options are
       complete. May be NULL. */
    bool (*write)(WrExportJob *job, const char *path, WrError *err);
    /* Fills codes or floats for texel rows [y, y + rows). */
    void (*rows)(WrExportJob *job, int y, int rows, void *out);
    /* Adds the file's attributes. */
    void (*describe)(WrExportJob *job);
} WrExportKind;

#define WR_EXPORT_KIND_COUNT 27
extern const WrExportKind wr_export_kinds[];
const WrExportKind *wr_export_find(const char *name); /* NULL if unknown */

/* depth 0, range auto, the scene's scheme, no dither; 64 lines along each axis seen from 30,35 */
WrExportOptions wr_export_default(void);

/* Sets one option from its text in a command: ("range", "0,1"). Errors name the option, the value and the
   allowed values; an option that the kind does not have is an error too. */
bool wr_export_option(const WrExportKind *kind, WrExportOptions *options, const char *name,
                      const char *value, WrError *err);
/* Sets options from words such as "depth=16"; an option given twice is an error. The options keep pointers into the words. */
bool wr_export_words(const WrExportKind *kind, const char *const *words, int count,
                     WrExportOptions *options, WrError *err);

/* Exports a file. Before the file is renamed to `path` the reader process reads it back, and its contents are
   compared with the table itself (report: seen, worst). Codes may be off by half a code, dithered ones by a
   whole one, floats must be equal: otherwise it is an error, and the old file stays. For lossy formats (JPEG)
   the error is only measured.

   document  read only     pool  may be NULL: one thread
   path      its extension selects the format
   report    may be NULL
   Errors    options out of range, a depth that the format does not support, the file of an object's mesh as `path`,
             any file error */
bool wr_export(const WrExportKind *kind, const WrDocument *document, const WrExportOptions *options,
               WrPool *pool, const char *path, WrExportReport *report, WrError *err);

/* Computes the mip levels of a kind that has them, without a file; the first level is computed as the source of
   the others, but not returned. levels: owned by the caller, wr_levels_free (mip_files.h). Errors: options out
   of range, no memory, "cancelled" */
typedef struct WrLevels WrLevels;
bool wr_export_levels(const WrExportKind *kind, const WrDocument *document,
                      const WrExportOptions *options, WrPool *pool, WrLevels *levels, WrError *err);

/* The report as one sentence: "512x512, 16 bits, F -0.2..1.4, codes 0..65535 are 0..1; 37 texels were outside
   the range and clipped". */
void wr_export_report_text(const WrExportReport *report, WrText *text);
