/* Document benchmark: an edit, its undo, saving and loading. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "cli/bench.h"
#include "command/session.h"
#include "document/document.h"
#include "document/document_file.h"
#include "field/field.h"
#include "system/clock.h"
#include "system/path.h"

#include <math.h>

static bool run(WrSession *session, const char *line, WrError *err)
{
    return wr_session_run(session, line, err);
}

/* A grid on the bottom layer, and one dab on each further layer. */
static bool make(WrSession *session, int size, int layers, const char *filter, WrError *err)
{
    char line[96];
    snprintf(line, sizeof line, "table %dx%d", size, size);
    if (!run(session, line, err) || !run(session, "grid", err)) return false;
    for (int i = 1; i < layers; i++) {
        snprintf(line, sizeof line, "layer add blend=%s", i % 2 ? "add" : "max");
        if (!run(session, line, err)) return false;
        snprintf(line, sizeof line, "dab %g,0.5 radius=32", i / 32.0);
        if (!run(session, line, err)) return false;
    }
    return !filter || (run(session, filter, err) && run(session, "layer use 1", err));
}

static double since(double start)
{
    return 1e3 * (wr_clock_seconds() - start);
}

bool wr_bench_edit(const WrCli *cli, WrBenchEdit *edit, int rounds, WrError *err)
{
    WrSession *session = wr_cli_session(cli, false, err);
    double *times[4];
    for (int k = 0; k < 4; k++) times[k] = wr_alloc((size_t)rounds, sizeof *times[k]);
    bool good = session && make(session, edit->table, edit->layers, edit->filter, err);
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
        if (good && wr_cancel_asked(cli->cancel)) good = wr_fail(err, "interrupted");
    }
    edit->dab_ms = wr_bench_median(times[0], rounds);
    edit->composite_ms = wr_bench_median(times[1], rounds);
    edit->undo_ms = wr_bench_median(times[2], rounds);
    edit->undo_composite_ms = wr_bench_median(times[3], rounds);
    for (int k = 0; k < 4; k++) wr_free(times[k]);
    wr_session_free(session);
    return good;
}

static WrDocument *make_document(int size, int layers, WrError *err)
{
    WrField *field = wr_bench_field(size, err);
    if (!field) return NULL;
    WrDocument *document = wr_document_new();
    wr_document_start_over(document, field);
    for (int i = 1; i < layers; i++) {
        WrLayer layer = wr_layer_new("detail", field);
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

bool wr_bench_file(WrBenchFile *file, WrError *err)
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
    bool good = wr_document_save(document, "", path, err);
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
