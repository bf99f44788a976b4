/* export.h - the table of F as files that other programs read: heights and normal maps of the unit
   cell. One row in wr_export_kinds a kind; a new kind is one function and one row.
   Layer 6.

   The cell is exported as it is painted: replicate, surface and camera are not in it. Row 0 of a file is
   the top row of the table. While the scene has an analytic F, that is sampled at the texels' centres
   instead of the table, at the table's size. object= takes what one of the scene's objects wears instead: its layer or its
   formula, and its scheme. Files are whole replacements (base/file.h): on any failure
   the target is as it was. The bytes are the same on any number of threads.

   height, integer codes 0..M, M = 255 or 65535 (never 256 or 65536):
   The range goes into the label (wrinkle:range), which `image` and opening read back (document/label.h).
     range lo,hi   code = round(M (F - lo) / (hi - lo)), clamped to 0..M; back: F = lo + code/M (hi - lo)
     range auto    lo, hi = the smallest and largest F; a flat table is code 0, with hi above lo
     range signed  code = Z + round((Z - 1) F / A), A = max |F|, Z = 128 or 32768: so 0 is exact
   height, float: the heights themselves, unchanged, one channel Y; range plays no part.

   normal+y, normal-y: at each texel's centre
     n = normalise(-height dF/dU / cell_w, -height dF/dV / cell_h, 1)
   (in millimetres, where the document's cell is told so, with its height; else in scene units)
   with dF/dU, dF/dV the scheme's derivatives of the table over the unit cell, V up. normal-y negates the
   second component. In a +Y map the upper flank of a bump is bright green. Codes are
   round(M (n/2 + 1/2)); float files hold n/2 + 1/2.

   axes=+x-z+y gives red, green and blue other components and signs, opengl and directx are +x+y+z and +x-y+z by name;
   strength= multiplies the slopes, which are true at 1. normal-object: the unit normal of the scene's surface as the
   bump turns it (shade/bump.h), along the object's axes, at (u,v) of the texel's centre. normal-baked: of a mesh, in the
   frames of MikkTSpace, with padding about its islands (baked.c).

   slopes, two channels of floats: p = height dF/dU / cell_w, q = height dF/dV / cell_h, V up, with the scheme's derivatives
   at each texel's centre. slope: atan sqrt(p^2 + q^2), 0 to 90 degrees as 0..M; float files hold degrees.

   curvature: minus the mean curvature of the relief over the cell, so that ridges are bright and grooves dark,
     H = ((1 + q^2) r - 2 p q s + (1 + p^2) t) / (2 (1 + p^2 + q^2)^(3/2)),   bumps have H < 0
   with r, s, t the means of the second derivatives over a texel, that is differences of p and q across it. Codes are
   Z + round((Z - 1) (-H) / full), Z = 128 or 32768, clamped: 0 is exact; float files hold -H, 1 / scene unit.

   curvature part=convex, concave: max(0, -H), max(0, H), from 0, which is code 0, to the largest or `full`.

   occlusion, horizon, cavity, direction, roughness: field/maps.h and field/occlusion.h say what a texel holds. Codes 0..M are
     occlusion, roughness  0 to 1          direction  0 to 360 degrees
     horizon               slopes 0 to the largest, in one direction; all directions, a channel each, are floats
     cavity                -full to 0: white is not in a cavity, black as deep as the deepest
   displacement: scale (F - ground), 0 or the lowest or a given height being the ground; coded like heights.
   mask: 1 from low to high, down to 0 over `feather` beyond either; sharp where that is 0.
   wear: of edges. With c = convex curvature over `full`, or what one texel in 50 is above, at most 1, and N a periodic noise of -1..1 of `grain` cells,
     max(0, min(1, (c (1 + noise N) - threshold) / (1 - threshold))).
   packed: several of these in one picture, a channel each, 0..1 of what their codes go over; curvature is 1/2 where it is 0.
   All but wear with noise are moved with the table, to the bit.

   bump-slopes: six channels of floats, h, dh/ds, dh/dt, their squares and product, h in table units, s to the right and t
   DOWN, per texel, or over the cell and divided by uvslopes=; in a tiled EXR of levels, of which each is the means of what
   its texels cover, under the names of OpenImageIO's maketx --bumpslopes. signs=renderman turns both slopes round.

   contact: maps as small pictures in one, each with its name.

   lines: a 3D line drawing of the cell with its hidden lines removed, the paper's figure 5, black on
   white; vectors where the ending is svg or pdf, else a picture of 8 bits. profile: F along a line of the cell
   as a chart, by the scheme's interpolation.

   stl, ply, obj: the relief on its surface (replicated, stretched as the object is) as a closed body of triangles in
   millimetres: open sheets get a back, tubes are filled or get a wall. Decimated: no sample of the table lies farther from
   its triangle than the error that was asked for, and the report says how far the farthest does. */
#pragma once
#include "base/enum_rows.h"
#include "field/certificate.h"

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

typedef enum WrExportPart { WR_EXPORT_BOTH, WR_EXPORT_CONVEX, WR_EXPORT_CONCAVE } WrExportPart;

typedef enum WrExportGround {
    WR_EXPORT_GROUND_ZERO,
    WR_EXPORT_GROUND_LOWEST,
    WR_EXPORT_GROUND_GIVEN
} WrExportGround;

/* What a channel of a packed picture holds. */
typedef struct WrExportPack {
    int filling; /* 0: as usual; a map of channel_packing.c, counted from 1; or NUMBER */
    double number;
} WrExportPack;
#define WR_PACK_NUMBER (-1)

/* How a cell is laid: see export's option lay=. */
#define WR_LAY_LIST(X)                                                                             \
    X(WR_LAY_PLAIN, "plain")                                                                       \
    X(WR_LAY_HALF_DROP, "half-drop")                                                               \
    X(WR_LAY_BRICK, "brick")                                                                       \
    X(WR_LAY_HEX, "hex")
typedef enum WrExportLay { WR_LAY_LIST(WR_WORD_ID) WR_LAYS } WrExportLay;
extern const char *const wr_lay_names[]; /* ends with NULL */

typedef struct WrExportOptions {
    int depth; /* bits a channel: 8, 16, 32 (float); 0 = the deepest that the ending holds */
    WrExportRange range; /* integer heights only; given is the only one that clips */
    double low, high;    /* range given: F of code 0 and of the last code, low < high */
    double amplitude; /* range signed: the height of the last code; 0: the largest that there is */
    double cell_w, cell_h; /* size of the unit cell in the unit of the scene's; 0: the scene's */
    int axes[3]; /* normals: what red, green and blue hold, 1 x, 2 y, 3 z, below 0 its opposite;
                        all 0: as the kind has it */
    int padding; /* baked normals: rings of texels about what is covered, 0..64 */
    int map_w, map_h; /* maps of a surface or a mesh: texels, 1..WR_FIELD_MAX; 0: the table's */
    double strength;  /* normals: slopes times this, finite, not 0 */
    int scheme;       /* normals: a WrScheme, or -1 for the scene's */
    const char *
        object; /* whose table; borrowed; NULL: of all layers, scheme and formula of the object at hand */
    double full; /* curvature: what is white, 1 / scene unit; 0: the largest that there is */
    /* Maps of the whole table: */
    int directions; /* occlusion, horizon: 4, 8, 16, 32 */
    int reach;      /* the same: texels; 0: all */
    double toward;  /* horizon: degrees; below 0: all directions, a channel each */
    double radius;  /* cavity: standard deviation of the blur, texels */
    int part;       /* curvature: a WrExportPart */
    int box;        /* roughness: texels, odd */
    double base;    /* roughness: Beckmann's alpha of the material, 0..1; below 0: the scene's */
    WrExportPack pack[4]; /* packed: red, green, blue, alpha */
    WrExportGround ground;
    double ground_at;           /* displacement: of ground given, table units */
    double scale;               /* displacement: of F = 1; NAN: the scene's height */
    double mask_low, mask_high; /* mask: NAN: the middle of the range; none */
    double feather;             /* mask: table units, >= 0 */
    double threshold;           /* wear: 0 up to 1 */
    double noise;               /* wear: 0..1 */
    int grain;                  /* wear: cells of the noise across the table */
    bool dither;                /* depth 8 only: ordered dither of up to half a code either way */
    bool
        half; /* 16-bit floats, in EXR alone: what depth 16 asks for there, whose depth then is 32 */
    /* sheets: the table is laid, repeated, brought to another size, set beside others, in this order */
    WrExportLay lay;
    int repeat_u, repeat_v; /* 0 or 1: once */
    int resize_w, resize_h; /* texels; 0: as they are, -1: the nearest powers of two */
    int filter;             /* of resize, WR_RESIZE_... (field/ops.h) */
    const char *atlas;      /* "A;B": files of further cells; borrowed; NULL: no atlas */
    int margin;             /* texels around each cell of an atlas */
    bool
        border; /* heights, normals, slopes: one sample more each way, at i/n by the scheme, the last of a periodic axis
                    the first again */
    bool mips;  /* files of half the size, a quarter and so on beside it */
    bool big;   /* files of numbers alone: the high byte first */
    bool sidecar; /* a file beside it says what it is; files of numbers alone have it in any case */
    bool renderman;           /* bump slopes: the signs of slopes turned round */
    double uvslopes;          /* bump slopes: over the cell, divided by this; 0: per texel */
    const char *contact_maps; /* contact: "A;B", kinds; borrowed; NULL: all of the cell */
    int contact_tile;         /* pixels of each */
    /* lines: */
    int lines_u, lines_v; /* lines along u, along v: 0..1024, not both 0; at most one a texel */
    double turn_deg, tilt_deg; /* about the vertical; above the horizon, 0..90 */
    double relief; /* height of F = 1 in cells; 0: so that all of it is a fifth of one high */
    int drawing_w, drawing_h; /* pixels, 16..4096 */
    double pen;               /* breadth of a line, pixels, 0.1..20 */
    bool hidden;              /* hidden lines are drawn as well */
    /* profile, whose size and pen are those of lines: */
    bool along_v; /* along v, else along u */
    double at;    /* the other coordinate, 0..1 */
    int grid;     /* divisions of the line, 1..256 */
    /* stl, ply, obj, in millimetres: */
    double solid_size;      /* longest side of the surface without its relief; 0: as the document's
                               cell says of a plane, if in millimetres, else 100 */
    double solid_error;     /* how far a sample may be off, > 0 */
    double solid_thickness; /* under the lowest sample; 0: 2 for a sheet, a tube is filled */
} WrExportOptions;

/* What was written, for the user to read. */
typedef struct WrExportReport {
    int width, height, channels, depth;
    bool half;        /* with depth 32: 16-bit floats */
    int64_t clipped;  /* texels outside the range */
    int64_t replaced; /* texels whose F or normal was not finite and became 0 (or straight up) */
    double low, high; /* smallest and largest F, table units */
    bool ranged;      /* integer heights: the next four hold */
    double code_low, code_high; /* F of code 0 and of the last code */
    int zero_code;        /* the code of F = 0 when it is exact by construction (signed), else -1 */
    double amplitude;     /* signed: A */
    const char *quantity; /* what low and high are of: "curvature"; NULL: heights */
    const char *convention; /* normals: "+Y (green up)"; else NULL */
    /* What reading the written file back showed; `seen` is false where nothing could be compared: drawings and bodies, which
     * are read back as bytes, and `unseen` pictures whose texels were only hashed, since a limit on file sizes leaves no
     * room for rows. */
    bool seen, unseen;
    WrCertificate
        seam;      /* how the cell's edges meet, by the scheme of the export, else the scene's */
    double worst;  /* largest error: table units, or the quantity's; of normals degrees */
    int64_t lines; /* drawings: visible stretches of lines; else 0 */
    /* Solids, in millimetres; triangles 0: none */
    int64_t triangles;
    double solid_error;   /* the largest distance of a sample of the table */
    double solid_size[3]; /* of the body, relief and back included */
    double solid_volume;  /* mm3 */
} WrExportReport;

typedef struct WrExportOptionInfo {
    const char *name;   /* as in commands: "range" */
    const char *values; /* for people: "LOW,HIGH, auto or signed" */
    const char *help;   /* a sentence with the default */
    bool (*set)(WrExportOptions *options, const char *value,
                WrError *err); /* use wr_export_option */
    bool named;                /* its value is the name of something of the document */
} WrExportOptionInfo;

#define WR_EXPORT_OPTIONS 20 /* most options of a kind */

#define WR_EXPORT_CHANNELS 32 /* at most */
#define WR_EXPORT_NAME 16     /* bytes of a channel's name */

typedef struct WrExportJob WrExportJob; /* private to the room */

typedef struct WrExportKind {
    const char *name, *label, *help;
    WrExportOptionInfo options[WR_EXPORT_OPTIONS + 1]; /* a NULL name ends the list */
    int channels;                                      /* of a picture; 0 of a body */
    bool floats;                                       /* no codes: the file must hold floats */
    bool levels; /* of levels, each the means of what it covers (mip_files.h) */
    const char *const *channel_names; /* [channels]; NULL: the usual ones */
    double green;                     /* normals: sign of the second component */
    bool on_surface;    /* it is of the scene's surface, in scene units, not of the cell */
    const char *ending; /* the one that its files must have; NULL: a picture's or a drawing's */
    /* The same, of options; NULL: `channels`, and the usual names. names: [WR_EXPORT_CHANNELS][WR_EXPORT_NAME] to be filled */
    int (*count_channels)(const WrExportJob *job, char (*names)[WR_EXPORT_NAME]);
    /* Make the whole map, which the rows then only put down: of kinds that must see all of the table. May be NULL. */
    bool (*make)(WrExportJob *job, WrError *err);
    /* What must be known of the whole table before the first row (ranges). May be NULL. */
    void (*prepare)(WrExportJob *job);
    /* Write the whole file, in place of what follows: drawings. The job's options are settled. May be
     * NULL. */
    bool (*write)(WrExportJob *job, const char *path, WrError *err);
    /* Fill codes or floats for texel rows [y, y + rows). */
    void (*rows)(WrExportJob *job, int y, int rows, void *out);
    /* Add the file's attributes. */
    void (*describe)(WrExportJob *job);
} WrExportKind;

#define WR_EXPORT_KIND_COUNT 24
extern const WrExportKind wr_export_kinds[];
const WrExportKind *wr_export_find(const char *name); /* NULL if there is none */

WrExportOptions
wr_export_default(void); /* depth 0, range auto, the scene's scheme, no dither; 64 lines each way
                            seen from 30,35 */

/* Set one option from its text as in a command: ("range", "0,1"). Errors name the option, the value and
 * what is allowed; an option that the kind lacks is an error too. */
bool wr_export_option(const WrExportKind *kind, WrExportOptions *options, const char *name,
                      const char *value, WrError *err);

/* Write the file. Before it takes its name it is read back by the reader process, and what stands there is
 * compared with the table itself (report: seen, worst). Codes may be wrong by half a code, dithered ones by a whole one,
 * floats not at all: else it is an error, and the old file stays. Formats that lose by their nature (JPEG) are
 * only measured.
 *
 * document  read only     pool  may be NULL: one thread
 * path      the format goes by its ending
 * report    may be NULL
 * Errors    options out of range, a depth that the format cannot hold, anything about the file */
bool wr_export(const WrExportKind *kind, const WrDocument *document, const WrExportOptions *options,
               WrPool *pool, const char *path, WrExportReport *report, WrError *err);

/* The levels of a kind that has such without a file; the first is made, as the others are made of it, but not kept, as where
 * one is written. levels: the caller's, wr_levels_free (mip_files.h); borrowed is nothing. Errors: options out of range, no memory, "cancelled" */
typedef struct WrLevels WrLevels;
bool wr_export_levels(const WrExportKind *kind, const WrDocument *document,
                      const WrExportOptions *options, WrPool *pool, WrLevels *levels, WrError *err);

/* The report as one sentence: "512x512, 16 bits, F -0.2..1.4, codes 0..65535 are 0..1; 37 texels were
 * outside the range and clipped". */
void wr_export_report_text(const WrExportReport *report, WrText *text);
