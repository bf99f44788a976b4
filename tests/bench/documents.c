/* Document benchmark: strokes, an edit and its undo, saving and loading. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "bench/bench.h"
#include "brush/brush.h"
#include "cli/cli.h"
#include "command/session.h"
#include "document/document.h"
#include "document/document_file.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "system/clock.h"
#include "system/path.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- strokes ---- */

typedef struct Stroke {
    int table;
    double apply_ms, apply_worst_ms; /* one stroke sample, radius 32 texels: median, worst */
    double preview_ms;               /* the 512 x 512 preview after it, median */
} Stroke;

static bool time_stroke(const WrCli *cli, Stroke *stroke, int samples, WrError *err)
{
    WrSession *session = wr_cli_session(cli, false, err);
    double *apply = wr_alloc((size_t)samples, sizeof *apply);
    double *preview = wr_alloc((size_t)samples, sizeof *preview);
    char line[64];
    WrFrame frame;
    snprintf(line, sizeof line, "table %dx%d", stroke->table, stroke->table);
    bool good = session && wr_session_run(session, "dials aa=point", err) &&
                wr_session_run(session, line, err) &&
                wr_session_run(session, "surface sphere", err) &&
                wr_session_run(session, "dials arithmetic=fast", err) &&
                wr_session_run(session, "dab 0.2,0.2 radius=40", err) &&
                wr_session_frame(session, 512, 512, 0, &frame, err) &&
                wr_session_stroke_begin(session, "stroke radius=32 strength=0.1", err);
    stroke->apply_worst_ms = 0;
    for (int i = 0; i < samples && good; i++) {
        /* A scribble in circles: about 10 texels per sample. */
        double t = 10.0 * i / stroke->table;
        WrSample sample = { .u = 0.5 + 0.3 * sin(3 * t),
                            .v = 0.5 + 0.3 * cos(2 * t),
                            .pressure = 1 };
        double start = wr_clock_seconds();
        good = wr_session_stroke_add(session, &sample, 1, err);
        double applied = wr_clock_seconds();
        good = good && wr_session_frame(session, 512, 512, 0, &frame, err);
        apply[i] = 1e3 * (applied - start);
        preview[i] = 1e3 * (wr_clock_seconds() - applied);
        stroke->apply_worst_ms = fmax(stroke->apply_worst_ms, apply[i]);
        if (wr_cancel_requested(cli->cancel)) good = wr_fail(err, "interrupted");
    }
    if (good) {
        stroke->apply_ms = wr_bench_median(apply, samples);
        stroke->preview_ms = wr_bench_median(preview, samples);
        good = wr_session_stroke_end(session, err);
    }
    wr_free(apply);
    wr_free(preview);
    wr_session_free(session);
    return good;
}

bool wr_bench_strokes(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    static const int tables[] = { 512, 4096 };
    wr_text_addf(text, "\nstroke of radius 32   %12s %12s %14s %14s\n", "event ms", "worst ms",
                 "preview ms", "event+preview");
    for (int i = 0; i < 2; i++) {
        Stroke stroke = { .table = tables[i] };
        char table[32];
        if (!time_stroke(cli, &stroke, quick ? 40 : 200, err)) return false;
        snprintf(table, sizeof table, "%dx%d", stroke.table, stroke.table);
        wr_text_addf(text, "  table %-13s %12.3f %12.3f %14.2f %14.2f\n", table, stroke.apply_ms,
                     stroke.apply_worst_ms, stroke.preview_ms, stroke.apply_ms + stroke.preview_ms);
    }
    return true;
}

/* ---- edits ---- */

/* Medians for a dab 64 texels across and for its undo, each including the update of the composite. */
typedef struct Edit {
    int table, layers;
    const char *further; /* command of a filter layer above, or of a group of layers; NULL: none */
    const char *use;     /* then the layer that is edited */
    double dab_ms, composite_ms, undo_ms, undo_composite_ms;
    double bytes; /* memory of the step */
} Edit;

static bool run(WrSession *session, const char *line, WrError *err)
{
    return wr_session_run(session, line, err);
}

/* A grid on the bottom layer, and one dab on each further layer. */
static bool make(WrSession *session, const Edit *edit, WrError *err)
{
    const int size = edit->table;
    char line[96];
    snprintf(line, sizeof line, "table %dx%d", size, size);
    if (!run(session, line, err) || !run(session, "grid", err)) return false;
    for (int i = 1; i < edit->layers; i++) {
        snprintf(line, sizeof line, "layer add blend=%s", i % 2 ? "add" : "max");
        if (!run(session, line, err)) return false;
        snprintf(line, sizeof line, "dab %g,0.5 radius=32", i / 32.0);
        if (!run(session, line, err)) return false;
    }
    return !edit->further || (run(session, edit->further, err) && run(session, edit->use, err));
}

static double since(double start)
{
    return 1e3 * (wr_clock_seconds() - start);
}

static bool time_edit(const WrCli *cli, Edit *edit, int rounds, WrError *err)
{
    WrSession *session = wr_cli_session(cli, false, err);
    double *times[4];
    for (int k = 0; k < 4; k++) times[k] = wr_alloc((size_t)rounds, sizeof *times[k]);
    bool good = session && make(session, edit, err);
    if (good) wr_document_composite(wr_session_document(session), cli->pool);
    for (int i = 0; i < rounds && good; i++) {
        char line[96];
        double t = 0.6180339887498949 * i;
        snprintf(line, sizeof line, "dab %.6f,%.6f radius=32", t - floor(t), fmod(0.37 * i, 1.0));
        double start = wr_clock_seconds();
        good = run(session, line, err);
        times[0][i] = since(start);
        start = wr_clock_seconds();
        wr_document_composite(wr_session_document(session), cli->pool);
        times[1][i] = since(start);
        int last = wr_session_history_count(session) - 1;
        edit->bytes = (double)wr_session_history_step_bytes(session, last);
        start = wr_clock_seconds();
        good = good && run(session, "undo", err);
        times[2][i] = since(start);
        start = wr_clock_seconds();
        wr_document_composite(wr_session_document(session), cli->pool);
        times[3][i] = since(start);
        if (good && wr_cancel_requested(cli->cancel)) good = wr_fail(err, "interrupted");
    }
    edit->dab_ms = wr_bench_median(times[0], rounds);
    edit->composite_ms = wr_bench_median(times[1], rounds);
    edit->undo_ms = wr_bench_median(times[2], rounds);
    edit->undo_composite_ms = wr_bench_median(times[3], rounds);
    for (int k = 0; k < 4; k++) wr_free(times[k]);
    wr_session_free(session);
    return good;
}

bool wr_bench_edits(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    static const int tables[] = { 512, 4096, 16384 }, layers[] = { 1, 20 };
    wr_text_addf(text, "\ndab of 64 texels       layers %9s %12s %9s %12s %9s\n", "dab ms",
                 "composite ms", "undo ms", "composite ms", "bytes");
    static const char *const further[] = { "filter blur sigma=3", "filter median radius=3",
                                           "filter warp", "filter curves points=0,0;0.3,0.1;1,1",
                                           "layer group G of=11..20" };
    for (int i = 0; i < 11; i++) {
        const bool group = i == 10;
        Edit edit = { .table = i < 6 ? tables[i / 2] : 4096,
                      .layers = i < 6   ? layers[i % 2]
                                : group ? 20
                                        : 1,
                      .further = i < 6 ? NULL : further[i - 6],
                      .use = group ? "layer use 20" : "layer use 1" };
        char table[32];
        if (edit.further) wr_text_addf(text, "    %s %s\n", group ? "in" : "below", edit.further);
        if (!time_edit(cli, &edit, quick ? 21 : 101, err)) return false;
        snprintf(table, sizeof table, "%dx%d", edit.table, edit.table);
        wr_text_addf(text, "  table %-13s %8d %9.3f %12.3f %9.3f %12.3f %9.0f\n", table,
                     edit.layers, edit.dab_ms, edit.composite_ms, edit.undo_ms,
                     edit.undo_composite_ms, edit.bytes);
    }
    return true;
}

/* ---- files ---- */

/* Saving and loading of a document of rough layers. */
typedef struct File {
    int table, layers;
    double save_seconds, load_seconds;
    double copy_seconds; /* oiiotool copying the file; 0: not installed */
} File;

static WrDocument *make_document(int size, int layers, WrError *err)
{
    WrField *field = wr_bench_field(size, err);
    if (!field) return NULL;
    WrDocument *document = wr_document_new();
    wr_document_start_over(document, field);
    for (int i = 1; i < layers; i++) {
        WrLayer layer = wr_layer_make("detail", field);
        wr_field_free(layer.heights);
        layer.heights = wr_field_share(field);
        wr_document_insert(document, i, layer);
    }
    return document;
}

/* Copy the same parts with oiiotool for comparison; seconds, or 0 if it is not installed. */
static double copy_with_oiiotool(const char *folder)
{
    char command[256];
    snprintf(command, sizeof command,
             "command -v oiiotool >/dev/null && oiiotool -a '%s/bench.exr' -o '%s/copy.exr' "
             ">/dev/null 2>&1",
             folder, folder);
    double start = wr_clock_seconds();
    bool good = system(command) == 0;
    double seconds = wr_clock_seconds() - start;
    snprintf(command, sizeof command, "%s/copy.exr", folder);
    wr_path_remove(command);
    return good ? seconds : 0;
}

static bool time_file(File *file, WrError *err)
{
    char folder[] = "/tmp/wrinkle-bench-XXXXXX", path[64];
    WrDocument *document = make_document(file->table, file->layers, err);
    if (!document) return false;
    if (!wr_folder_make_temporary(folder)) {
        wr_document_free(document);
        return wr_fail(err, "%s: no folder can be made there", folder);
    }
    snprintf(path, sizeof path, "%s/bench.exr", folder);
    wr_document_field(document);
    double start = wr_clock_seconds();
    bool good = wr_document_save(document, "", path, NULL, err);
    file->save_seconds = wr_clock_seconds() - start;
    wr_document_free(document);
    WrLoaded loaded = { 0 };
    int64_t replaced;
    start = wr_clock_seconds();
    good = good && wr_document_load(path, &loaded, &replaced, err);
    file->load_seconds = wr_clock_seconds() - start;
    wr_document_free(loaded.document);
    wr_free(loaded.scene_text);
    file->copy_seconds = good ? copy_with_oiiotool(folder) : 0;
    wr_path_remove(path);
    wr_folder_remove(folder);
    return good;
}

bool wr_bench_files(bool quick, WrText *text, WrError *err)
{
    File file = { .table = quick ? 1024 : 4096, .layers = 5 };
    if (!time_file(&file, err)) return false;
    wr_text_addf(text, "\ndocument %dx%d, %d layers: save %.2f s, load %.2f s\n", file.table,
                 file.table, file.layers, file.save_seconds, file.load_seconds);
    if (file.copy_seconds > 0)
        wr_text_addf(text, "oiiotool reading and writing the same file: %.2f s (ours %.2f s)\n",
                     file.copy_seconds, file.save_seconds + file.load_seconds);
    return true;
}
