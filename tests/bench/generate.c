/* Benchmark of generators and operations on whole tables, compared with GEGL and oiiotool if these are installed.
 *
 * Our time is that of the command in a running program, including the update of the composite. Exports include their
 * read-back. Maps exclude the writing, which is measured separately. The time of another program is that of its whole
 * process, minus that of a process that only loads and saves the picture. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "command/session.h"
#include "document/document.h"
#include "export/export.h"
#include "export/mip_files.h"
#include "export/preview.h"
#include "image/image.h"
#include "system/clock.h"
#include "system/path.h"

#include <math.h>
#include <string.h>

#define TABLE 4096
#define CROP 1024 /* table part for oiiotool, which is slow */
#define ROUNDS_MAX 9
#define MESH_SIDE 708 /* squares along a side, two triangles each: 1 002 528 triangles */
#define TEXT_LINES 60
#define TEXT_GLYPHS 50 /* per line */

typedef enum Kind {
    NOISE,
    BLUR,
    NORMALS,
    NORMALS_HELD,
    NORMALS_PNG,
    OCCLUSION,
    OCCLUSION_HELD,
    PNG,
    EXR,
    BUMP_SLOPES,
    TEXT,
    ROUND_TEXT,
    RIVETS,
    MESH,
    KIND_COUNT
} Kind;

/* A row: one of our commands, and GEGL's equivalent, if any. */
typedef struct Row {
    const char *name, *label;
    const char *line; /* NULL: generated at run time */
    const char *gegl; /* arguments; run in the benchmark's folder */
    const char *bare; /* the same without the operation */
    const char *file; /* an export: name of the written file */
    int channels;     /* channels of the file if the writing is excluded from the time; else 0 */
    bool oiiotool;    /* oiiotool writes the same file from the same heights */
    bool like;        /* GEGL's time is that of the row above */
} Row;

WR_ROWS(rows);
static const Row rows[KIND_COUNT] = {
    [WR_ROW(NOISE)] = { "noise", "gradient noise, 6 octaves", "noise gradient cells=8 octaves=6",
                        "-o out.tif -- gegl:perlin-noise alpha=1.2 scale=1.8 "
                        "n=6 gegl:crop width=4096 height=4096",
                        "in.tif -o out.tif" },
    [WR_ROW(BLUR)] = { "blur", "Gaussian blur, sigma 10.67", "adjust blur sigma=10.67",
                       "in.tif -o out.tif -- gegl:gaussian-blur std-dev-x=10.67 std-dev-y=10.67 "
                       "abyss-policy=none",
                       "in.tif -o out.tif" },
    [WR_ROW(NORMALS)] = { "normals", "normal map", NULL,
                          "in.tif -o out.tif -- gegl:normal-map scale=10 tileable=true",
                          "in.tif -o out.tif -- gegl:convert-format format='RGB float'",
                          .file = "out.bmp", .channels = 3 },
    [WR_ROW(NORMALS_HELD)] = { "normals-held", "the same, in memory alone", NULL, "", "",
                               .like = true },
    [WR_ROW(NORMALS_PNG)] = { "normals-png", "normal map as 8-bit PNG", NULL,
                              "in.tif -o one.tif -- gegl:normal-map scale=10 tileable=true "
                              "gegl:png-save path=out.png bitdepth=8",
                              "in.tif -o one.tif -- gegl:crop width=1 height=1",
                              .file = "out.png" },
    [WR_ROW(OCCLUSION)] = { "occlusion", "occlusion, 8 directions", NULL, .file = "out.bmp",
                            .channels = 1 },
    [WR_ROW(OCCLUSION_HELD)] = { "occlusion-held", "the same, in memory alone", NULL },
    [WR_ROW(PNG)] = { "png", "heights as 16-bit PNG", NULL, .file = "out.png", .oiiotool = true },
    [WR_ROW(EXR)] = { "exr", "heights as float EXR", NULL, .file = "out.exr", .oiiotool = true },
    [WR_ROW(BUMP_SLOPES)] = { "bump-slopes", "bump slopes, all levels", NULL, NULL, NULL },
    [WR_ROW(TEXT)] = { "text", "text, 3000 letters", NULL, NULL, NULL },
    [WR_ROW(ROUND_TEXT)] = { "text-round", "the same, rounded", NULL, NULL, NULL },
    [WR_ROW(RIVETS)] = { "rivets", "10000 spheres", "solid sphere radius=16 across=100 rows=100",
                         NULL, NULL },
    [WR_ROW(MESH)] = { "mesh", "mesh, 1002528 triangles", NULL, NULL, NULL },
};
WR_ROWS_END(rows, KIND_COUNT);

typedef struct Bench {
    const WrCli *cli;
    WrSession *session;
    char folder[40];
    WrText lines[KIND_COUNT]; /* command lines */
    bool gegl, oiiotool;      /* the programs are installed */
    int rounds;
    double ours[KIND_COUNT][ROUNDS_MAX], peer[KIND_COUNT][ROUNDS_MAX], bare[KIND_COUNT][ROUNDS_MAX];
    double oiiotool_ms; /* blur, scaled to a whole table; 0: unknown */
    double maketx_ms;   /* bump slopes, scaled to a whole table; 0: unknown */
} Bench;

/* Run a shell command in the benchmark's folder; milliseconds, or an error with the command. */
static bool shell(const Bench *b, const char *command, double *ms, WrError *err)
{
    WrText line = { 0 };
    int threads = wr_bench_threads(b->cli);
    wr_text_addf(&line,
                 "cd '%s' && GEGL_USE_OPENCL=no GEGL_SWAP=RAM GEGL_CACHE_SIZE=4096 GEGL_THREADS=%d "
                 "%s >/dev/null 2>&1",
                 b->folder, threads, command);
    double start = wr_clock_seconds();
    bool good = system(wr_text_get(&line)) == 0;
    *ms = 1e3 * (wr_clock_seconds() - start);
    wr_text_fini(&line);
    if (!good && wr_cancel_requested(b->cli->cancel)) return wr_fail(err, "interrupted");
    return good || wr_fail(err, "bench: this failed: %.180s", command);
}

static bool gegl(const Bench *b, const char *arguments, double *ms, WrError *err)
{
    WrText command = { 0 };
    wr_text_addf(&command, "gegl %s", arguments);
    bool good = shell(b, wr_text_get(&command), ms, err);
    wr_text_fini(&command);
    return good;
}

/* Write a wavy mesh of triangles as a PLY file. */
static bool write_mesh(const char *path, WrError *err)
{
    FILE *file = fopen(path, "wb");
    if (!file) return wr_fail(err, "%s: cannot be written", path);
    int n = MESH_SIDE + 1;
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty "
            "float y\nproperty float z\nelement face %d\nproperty list uchar int "
            "vertex_indices\nend_header\n",
            n * n, 2 * MESH_SIDE * MESH_SIDE);
    for (int k = 0; k < n * n; k++) {
        double x = (double)(k % n) / MESH_SIDE, y = (double)(k / n) / MESH_SIDE;
        const float p[3] = { (float)x, (float)y,
                             (float)(0.02 * sin(40 * x + 3 * sin(9 * y)) * cos(31 * y)) };
        fwrite(p, sizeof p, 1, file);
    }
    for (int k = 0; k < 2 * MESH_SIDE * MESH_SIDE; k++) {
        int a = k / 2 / MESH_SIDE * n + k / 2 % MESH_SIDE;
        const int32_t face[3] = { k % 2 ? a + 1 : a, k % 2 ? a + n + 1 : a + 1, a + n };
        fputc(3, file);
        fwrite(face, sizeof face, 1, file);
    }
    bool good = !ferror(file);
    return (fclose(file) == 0 && good) || wr_fail(err, "%s: cannot be written", path);
}

static void add_text_line(WrText *line, const char *profile)
{
    uint32_t seed = 1;
    wr_text_add(line, "text \"");
    for (int i = 0; i < TEXT_LINES; i++) {
        if (i > 0) wr_text_add(line, "\\\\n");
        for (int k = 0; k < TEXT_GLYPHS; k++) {
            seed = seed * 1664525u + 1013904223u;
            wr_text_addf(line, "%s%c", k > 0 && k % 6 == 0 ? " " : "",
                         (int)('a' + (seed >> 16) % 26));
        }
    }
    wr_text_addf(line, "\" font=serif size=56 %s", profile);
}

static void write_lines(Bench *b)
{
    for (int i = 0; i < KIND_COUNT; i++)
        if (rows[i].line) wr_text_add(&b->lines[i], rows[i].line);
    wr_text_addf(&b->lines[NORMALS], "export normal+y \"%s/out.bmp\" depth=8", b->folder);
    wr_text_addf(&b->lines[NORMALS_PNG], "export normal+y \"%s/out.png\" depth=8", b->folder);
    wr_text_addf(&b->lines[OCCLUSION], "export occlusion \"%s/out.bmp\" depth=8 directions=8",
                 b->folder);
    wr_text_addf(&b->lines[PNG], "export height \"%s/out.png\" depth=16", b->folder);
    wr_text_addf(&b->lines[EXR], "export height \"%s/out.exr\" depth=32", b->folder);
    add_text_line(&b->lines[TEXT], "");
    add_text_line(&b->lines[ROUND_TEXT], "profile=round bevel=6");
    wr_text_addf(&b->lines[MESH], "solid mesh \"%s/mesh.ply\" size=4000", b->folder);
}

/* Write the table as a picture for the other programs, in the format that GEGL itself saves. */
static bool write_pictures(const Bench *b, WrError *err)
{
    char line[96];
    double ms;
    if (!b->gegl && !b->oiiotool) return true;
    snprintf(line, sizeof line, "export height \"%s/table.tif\"", b->folder);
    if (!wr_session_run(b->session, line, err)) return false;
    if (b->gegl && !gegl(b, "table.tif -o in.tif", &ms, err)) return false;
    return !b->oiiotool ||
           shell(b, "oiiotool table.tif --cut 1024x1024 --compression none -o crop.tif", &ms, err);
}

static bool present(const char *program)
{
    char command[64];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", program);
    return system(command) == 0;
}

static bool begin(Bench *b, WrError *err)
{
    const WrSessionOptions options = { .pool = b->cli->pool, .outputs = true };
    strcpy(b->folder, "/tmp/wrinkle-bench-XXXXXX");
    if (!wr_folder_make_temporary(b->folder)) {
        wr_fail(err, "%s: no folder can be made there", b->folder);
        b->folder[0] = 0;
        return false;
    }
    char path[64], line[32];
    snprintf(path, sizeof path, "%s/mesh.ply", b->folder);
    snprintf(line, sizeof line, "table %dx%d", TABLE, TABLE);
    b->gegl = present("gegl");
    b->oiiotool = present("oiiotool");
    write_lines(b);
    b->session = wr_session_new(&options);
    return write_mesh(path, err) && wr_session_run(b->session, line, err) &&
           wr_session_run(b->session, rows[NOISE].line, err) && write_pictures(b, err);
}

static void end(Bench *b)
{
    static const char *const files[] = {
        "mesh.ply", "table.tif", "in.tif",  "crop.tif", "out.tif",
        "out.bmp",  "out.png",   "out.exr", "six.exr",  "one.tif"
    };
    char path[64];
    for (size_t i = 0; i < sizeof files / sizeof *files && b->folder[0]; i++) {
        snprintf(path, sizeof path, "%s/%s", b->folder, files[i]);
        wr_path_remove(path);
    }
    if (b->folder[0]) wr_folder_remove(b->folder);
    for (int i = 0; i < KIND_COUNT; i++) wr_text_fini(&b->lines[i]);
    wr_session_free(b->session);
}

/* Time to write an 8-bit picture of the same size; overwrites the exported one. */
static bool time_write(const Bench *b, int channels, double *ms, WrError *err)
{
    char path[64];
    snprintf(path, sizeof path, "%s/out.bmp", b->folder);
    unsigned char *codes = wr_try_alloc((size_t)TABLE * TABLE, (size_t)channels, "a picture", err);
    if (!codes) return false;
    memset(codes, 128, (size_t)TABLE * TABLE * (size_t)channels);
    double start = wr_clock_seconds();
    bool good = wr_image_write_pixels(path, TABLE, TABLE, channels, WR_PIXEL_U8, true, codes, err);
    *ms = 1e3 * (wr_clock_seconds() - start);
    wr_free(codes);
    return good;
}

/* Computed in memory: writing files of six channels needs far longer than the computation. */
static bool time_levels(const Bench *b, double *ms, WrError *err)
{
    const WrExportOptions options = wr_export_default();
    const WrDocument *document = wr_session_document(b->session);
    WrLevels levels;
    const double start = wr_clock_seconds();
    const bool good = wr_export_levels(wr_export_find("bump-slopes"), document, &options,
                                       b->cli->pool, &levels, err);
    *ms = 1e3 * (wr_clock_seconds() - start);
    if (good) wr_levels_free(&levels);
    return good;
}

/* Compute a map without writing and read-back, as the other program does. */
static bool time_held(const Bench *b, const char *kind, double *ms, WrError *err)
{
    WrExportOptions options = wr_export_default();
    WrExportPreview picture;
    options.directions = 8; /* of occlusion */
    const double start = wr_clock_seconds();
    const bool good = wr_export_preview(wr_export_find(kind), wr_session_document(b->session),
                                        &options, b->cli->pool, &picture, err);
    *ms = 1e3 * (wr_clock_seconds() - start);
    wr_export_preview_fini(&picture);
    return good;
}

/* Time one of our commands. Changes of the table are undone, so that all rounds are equal. */
static bool time_ours(const Bench *b, Kind kind, double *ms, WrError *err)
{
    double start = wr_clock_seconds(), bare = 0;
    if (kind == BUMP_SLOPES) return time_levels(b, ms, err);
    if (kind == NORMALS_HELD) return time_held(b, "normal+y", ms, err);
    if (kind == OCCLUSION_HELD) return time_held(b, "occlusion", ms, err);
    if (!wr_session_run(b->session, wr_text_get(&b->lines[kind]), err)) return false;
    wr_document_composite(wr_session_document(b->session), b->cli->pool);
    *ms = 1e3 * (wr_clock_seconds() - start);
    if (!rows[kind].file) return wr_session_run(b->session, "undo", err);
    if (!rows[kind].channels) return true;
    if (!time_write(b, rows[kind].channels, &bare, err)) return false;
    *ms -= bare;
    return true;
}

/* Time oiiotool for the same file, and for only reading its input. */
static bool time_file(const Bench *b, const Row *row, double *whole, double *bare, WrError *err)
{
    char command[96];
    int threads = wr_bench_threads(b->cli);
    snprintf(command, sizeof command,
             "oiiotool --threads %d -i:now=1 table.tif --cut 1x1 -o out.tif", threads);
    if (!shell(b, command, bare, err)) return false;
    snprintf(command, sizeof command, "oiiotool --threads %d table.tif -d %s -o %s", threads,
             strcmp(row->file, "out.png") == 0 ? "uint16" : "float", row->file);
    return shell(b, command, whole, err);
}

static bool round_of(Bench *b, int round, WrError *err)
{
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        const Row *row = &rows[kind];
        if (!time_ours(b, (Kind)kind, &b->ours[kind][round], err)) return false;
        if (row->like) {
            b->bare[kind][round] = b->bare[kind - 1][round];
            b->peer[kind][round] = b->peer[kind - 1][round];
        } else if (b->gegl && row->gegl &&
                   (!gegl(b, row->bare, &b->bare[kind][round], err) ||
                    !gegl(b, row->gegl, &b->peer[kind][round], err)))
            return false;
        if (b->oiiotool && row->oiiotool &&
            !time_file(b, row, &b->peer[kind][round], &b->bare[kind][round], err))
            return false;
        if (wr_cancel_requested(b->cli->cancel)) return wr_fail(err, "interrupted");
    }
    return true;
}

/* Run once, on a part of the table. */
static bool time_oiiotool(Bench *b, WrError *err)
{
    char command[96];
    double bare, whole;
    int threads = wr_bench_threads(b->cli);
    if (!b->oiiotool) return true;
    snprintf(command, sizeof command, "oiiotool --threads %d crop.tif -o out.tif", threads);
    if (!shell(b, command, &bare, err)) return false;
    snprintf(command, sizeof command, "oiiotool --threads %d crop.tif --blur 65x65 -o out.tif",
             threads);
    if (!shell(b, command, &whole, err)) return false;
    b->oiiotool_ms = (whole - bare) * ((double)TABLE / CROP) * ((double)TABLE / CROP);
    return true;
}

/* Time maketx on a part of the table, minus a process that loads and saves its six channels. */
static bool time_maketx(Bench *b, WrError *err)
{
    double bare, whole;
    if (!b->oiiotool || !present("maketx")) return true;
    if (!shell(b, "maketx --bumpslopes --compression none --format openexr crop.tif -o six.exr",
               &whole, err) ||
        !shell(b, "oiiotool six.exr --tile 64 64 --compression none -o out.exr", &bare, err))
        return false;
    b->maketx_ms = (whole - bare) * ((double)TABLE / CROP) * ((double)TABLE / CROP);
    return true;
}

/* Net time of the other program; a difference below 0 is noise of two processes and is reported as 0. */
static double net(Bench *b, int kind)
{
    double ms =
        wr_bench_median(b->peer[kind], b->rounds) - wr_bench_median(b->bare[kind], b->rounds);
    return ms > 0 ? ms : 0;
}

static const char *peer_of(const Bench *b, int kind)
{
    if (rows[kind].gegl && b->gegl) return "gegl";
    return rows[kind].oiiotool && b->oiiotool ? "oiiotool" : NULL;
}

static void add_row(WrText *text, const char *label, double ours, const char *who, double peer)
{
    wr_text_addf(text, "  %-28s %10.1f", label, ours);
    if (who && peer > 0 && ours > 0)
        wr_text_addf(text, "  %-9s %10.1f %8.2f\n", who, peer, peer / ours);
    else if (who) wr_text_addf(text, "  %-9s %10s\n", who, "too short");
    else wr_text_add(text, "\n");
}

static void print_table(Bench *b, WrText *text)
{
    wr_text_addf(text, "\n%-30s %10s  %-9s %10s %8s\n", "made at once, table 4096x4096", "ms",
                 "peer", "ms", "ratio");
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        double ours = wr_bench_median(b->ours[kind], b->rounds);
        const char *peer = peer_of(b, kind);
        add_row(text, rows[kind].label, ours, peer, peer ? net(b, kind) : 0);
        if (kind == BLUR && b->oiiotool) add_row(text, "", ours, "oiiotool", b->oiiotool_ms);
        if (kind == BUMP_SLOPES && b->maketx_ms > 0)
            add_row(text, "", ours, "maketx", b->maketx_ms);
    }
    if (b->maketx_ms > 0) wr_text_addf(text, "  maketx is timed likewise, on %dx%d\n", CROP, CROP);
    if (b->oiiotool)
        wr_text_addf(text, "  oiiotool's blur is 65x65, timed on %dx%d and counted %d times\n",
                     CROP, CROP, TABLE / CROP * (TABLE / CROP));
    if (!b->gegl) wr_text_add(text, "  gegl is not installed: left out\n");
    if (!b->oiiotool) wr_text_add(text, "  oiiotool is not installed: left out\n");
}

static void print_lines(Bench *b, WrText *text)
{
    int threads = wr_bench_threads(b->cli);
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        wr_text_addf(text, "make %s wrinkle %d %d %.4f\n", rows[kind].name, TABLE, threads,
                     wr_bench_median(b->ours[kind], b->rounds));
        if (peer_of(b, kind))
            wr_text_addf(text, "make %s %s %d %d %.4f\n", rows[kind].name, peer_of(b, kind), TABLE,
                         threads, net(b, kind));
        if (kind == BUMP_SLOPES && b->maketx_ms > 0)
            wr_text_addf(text, "make %s maketx %d %d %.4f\n", rows[kind].name, TABLE, threads,
                         b->maketx_ms);
        if (kind == BLUR && b->oiiotool)
            wr_text_addf(text, "make %s oiiotool %d %d %.4f\n", rows[kind].name, TABLE, threads,
                         b->oiiotool_ms);
    }
}

bool wr_bench_generate(const WrCli *cli, bool quick, bool lines, WrText *text, WrError *err)
{
    Bench *b = wr_alloc(1, sizeof *b);
    b->cli = cli;
    b->rounds = quick ? 1 : 5;
    bool good = begin(b, err);
    for (int round = -1; round < b->rounds && good; round++) /* the first round fills caches */
        good = round_of(b, round < 0 ? 0 : round, err);
    good = good && time_oiiotool(b, err) && time_maketx(b, err);
    if (good && lines) print_lines(b, text);
    if (good && !lines) print_table(b, text);
    end(b);
    wr_free(b);
    return good;
}
