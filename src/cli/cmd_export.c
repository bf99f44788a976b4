#include "cli/cli.h"

#include "base/array.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/session.h"
#include "command/variants.h"
#include "export/export.h"
#include "export/map_sets.h"
#include "export/receipt.h"
#include "system/clock.h"
#include "system/file_watch.h"
#include "system/path.h"
#include "system/thread.h"

#include <errno.h>
#include <string.h>

/* Names of kinds, then of sets. */
static const char *kind_or_set(const void *ctx, int i)
{
    const WrMapSetNames *sets = ctx;
    if (i < WR_EXPORT_KIND_COUNT) return wr_export_kinds[i].name;
    i -= WR_EXPORT_KIND_COUNT;
    return i < sets->names.count ? sets->names.data[i] : NULL;
}

/* Error for a name that is neither a kind nor a set. */
static bool fail_unknown(const char *name, WrError *err)
{
    WrMapSetNames sets = wr_map_set_names();
    int unused;
    wr_cli_find_word("--as", name, kind_or_set, &sets, &unused, err);
    wr_map_set_names_free(&sets);
    return false;
}

/* Identity of an input file when it was read. */
typedef struct Input {
    char *path; /* owned */
    WrFileIdentity stamp;
} Input;

/* The previous export while a file is watched. */
typedef struct Last {
    bool written;           /* files were written at least once */
    bool there;             /* the files on disk match `hash` */
    bool unread;            /* FILE was unreadable, or one of its commands failed */
    WrHash hash;            /* hash of the document */
    WR_ARRAY(Input) inputs; /* input files besides FILE itself, of the last readable FILE */
} Last;

static void forget_inputs(Last *last)
{
    for (int i = 0; i < last->inputs.count; i++) wr_free(last->inputs.data[i].path);
    wr_array_free(&last->inputs);
}

/* wr_cli_load that also records whether FILE itself failed. */
static WrSession *load(const WrCli *cli, Last *last, WrError *err)
{
    WrSession *session = wr_cli_session(cli, false, err);
    last->unread = session && !wr_cli_open(cli, session, err);
    if (session && !last->unread && wr_cli_run_dos(cli, session, err)) return session;
    wr_session_free(session);
    return NULL;
}

/* True if the document is unchanged, so that its files are current. Stores its input files. */
static bool is_last(const WrSession *session, Last *last)
{
    const WrHash hash = wr_session_hash(session);
    const bool same = last->there && wr_hash_equal(hash, last->hash);
    forget_inputs(last);
    for (int i = 0; i < wr_session_input_count(session); i++) {
        const WrSessionInput input = wr_session_input(session, i);
        wr_array_push(&last->inputs, ((Input){ wr_strdup(input.path), input.stamp }));
    }
    last->there = same;
    last->hash = hash;
    return same;
}

/* One export of a loaded document: a file or, for a set, files. */
typedef struct Export {
    const WrCli *cli;
    WrSession *session;
    const WrExportKind *kind; /* or */
    const WrMapSet *set;
    const WrExportOptions *options;
    WrText *report;
} Export;

static bool write_file(void *ctx, const char *variant, WrError *err)
{
    const Export *export = ctx;
    WrExportReport written;
    char *name = wr_variant_fill(export->cli->out, variant);
    char *out = wr_session_output_name(export->session, name, err);
    const double began = wr_clock_seconds();
    bool good = out && wr_session_check_export(export->session, export->kind, out, err) &&
                wr_export(export->kind, wr_session_document(export->session), export->options,
                          export->cli->pool, out, &written, err);
    if (good && export->cli->json) {
        const WrReceipt receipt = { out, export->kind->name, written, wr_clock_seconds() - began };
        good = wr_cli_add_receipt(export->cli, &receipt, export->report, err);
    } else if (good) {
        wr_text_addf(export->report, "%s: ", export->cli->shown ? export->cli->shown : out);
        wr_export_report_text(&written, export->report);
        wr_text_add(export->report, "\n");
    }
    wr_free(name);
    wr_free(out);
    return good;
}

static bool export_file(const WrCli *cli, const WrExportKind *kind, Last *last, WrText *report,
                        WrError *err)
{
    WrExportOptions options = wr_export_default();
    if (!wr_export_words(kind, cli->words, cli->word_count, &options, err)) return false;
    if (cli->shown && options.sidecar == WR_EXPORT_SIDECAR_LEFT_OUT)
        options.sidecar = WR_EXPORT_SIDECAR_OFF; /* standard output holds one file */
    WrSession *session = load(cli, last, err);
    if (!session) return false;
    Export export = { cli, session, kind, NULL, &options, report };
    const bool good = is_last(session, last) ||
                      wr_session_for_variants(session, cli->out, write_file, &export, err);
    wr_session_free(session);
    return good;
}

/* Copy all words except name=, which sets the name of the cell. Returns their number; at most one more than fit. */
static int take_name(const WrCli *cli, const char *words[WR_MAP_SET_WORDS_MAX + 1], WrText *name)
{
    int count = 0;
    for (int i = 0; i < cli->word_count && count <= WR_MAP_SET_WORDS_MAX; i++) {
        if (strncmp(cli->words[i], "name=", 5) != 0) {
            words[count++] = cli->words[i];
            continue;
        }
        wr_text_clear(name);
        wr_text_add(name, cli->words[i] + 5);
    }
    return count;
}

static bool write_maps(void *ctx, const char *variant, WrError *err)
{
    const Export *export = ctx;
    const WrCli *cli = export->cli;
    WrText name = { 0 };
    const char *words[WR_MAP_SET_WORDS_MAX + 1];
    wr_map_set_cell_name(cli->file, &name);
    const int count = take_name(cli, words, &name);
    char *cell = wr_variant_fill(wr_text_get(&name), variant);
    char *folder = wr_variant_fill(cli->out, variant);
    WrText list = { 0 };
    WrReceipts receipts = { 0 };
    const WrMapSetRequest order = { export->set, folder, cell, words, count, &receipts };
    bool good =
        wr_export_map_set(&order, wr_session_document(export->session), cli->pool, &list, err);
    if (!cli->json) wr_text_add(export->report, wr_text_get(&list));
    for (int i = 0; good && cli->json && i < receipts.files.count; i++)
        good = wr_cli_add_receipt(cli, &receipts.files.data[i], export->report, err);
    wr_receipts_free(&receipts);
    wr_text_fini(&list);
    wr_free(cell);
    wr_free(folder);
    wr_text_fini(&name);
    return good;
}

static bool export_maps(const WrCli *cli, const WrMapSet *set, Last *last, WrText *report,
                        WrError *err)
{
    WrSession *session = load(cli, last, err);
    if (!session) return false;
    Export export = { cli, session, NULL, set, NULL, report };
    const char *path = cli->out; /* or the name of the cell has the pattern */
    for (int i = 0; i < cli->word_count && !wr_variant_is_pattern(path); i++)
        if (strncmp(cli->words[i], "name=", 5) == 0) path = cli->words[i] + 5;
    const bool good =
        is_last(session, last) || wr_session_for_variants(session, path, write_maps, &export, err);
    wr_session_free(session);
    return good;
}

static bool is_set(const char *name)
{
    WrMapSetNames sets = wr_map_set_names();
    bool found = false;
    for (int i = 0; i < sets.names.count; i++) found |= strcmp(sets.names.data[i], name) == 0;
    wr_map_set_names_free(&sets);
    return found;
}

bool wr_cli_check_kind(const char *name, WrError *err)
{
    return wr_export_find(name) || is_set(name) || fail_unknown(name, err);
}

static bool export_as(const WrCli *cli, Last *last, WrText *report, WrError *err)
{
    const WrExportKind *kind = wr_export_find(cli->kind);
    if (kind) return export_file(cli, kind, last, report, err);
    if (!wr_cli_check_kind(cli->kind, err)) return false;
    WrMapSet *set = wr_map_set_find(cli->kind, err);
    bool good = set && export_maps(cli, set, last, report, err);
    wr_map_set_free(set);
    return good;
}

static int export_once(const WrCli *cli, Last *last)
{
    WrError err;
    WrText report = { 0 };
    int status;
    if (export_as(cli, last, &report, &err)) {
        last->there = last->written = true;
        status = wr_cli_report(cli, &report);
    } else {
        status = wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    wr_text_fini(&report);
    return status;
}

/* ---- --watch ---- */

#define SETTLE_SECONDS 0.2 /* time without another change before the file counts as complete */
#define DAY_SECONDS 86400.0

static bool is_cancelled(const WrCli *cli)
{
    return wr_cancel_requested(cli->cancel);
}

/* True if the file or one of its inputs has changed. A missing input, as during its replacement, counts when it is
   back. A changed script counts at once, since it may no longer need that input. */
static bool is_another(const WrCli *cli, WrFileIdentity *stamp, const Last *last)
{
    const WrFileIdentity now = wr_file_identity(cli->file);
    bool other = false;
    if (!now.there) return false;
    if (!wr_file_identity_same(&now, stamp)) other = true, *stamp = now;
    for (int i = 0; i < last->inputs.count; i++) {
        const Input *input = &last->inputs.data[i];
        const WrFileIdentity own = wr_file_identity(input->path);
        other |= own.there && !wr_file_identity_same(&own, &input->stamp);
    }
    return other;
}

/* Wait until no change has come for SETTLE_SECONDS; a file that another program still writes is empty or in part. A
   file that replaced another by its name is complete. */
static WrWatchEnd settle(const WrCli *cli, WrWatch *watch)
{
    WrWatchEnd end;
    do end = wr_watch_wait(watch, SETTLE_SECONDS);
    while ((end == WR_WATCH_CHANGED || end == WR_WATCH_REPLACED) && !is_cancelled(cli));
    return end;
}

/* Wait for a change that stays for a moment. False: an error, or an interrupt. */
static bool wait_for_change(const WrCli *cli, WrWatch *watch, WrFileIdentity *stamp,
                            const Last *last, WrError *err)
{
    bool other = is_another(cli, stamp, last); /* since the file was read */
    for (;;) {
        WrWatchEnd end = other ? WR_WATCH_CHANGED : wr_watch_wait(watch, DAY_SECONDS);
        if (end == WR_WATCH_CHANGED) end = settle(cli, watch);
        if (is_cancelled(cli)) return wr_fail(err, "interrupted");
        if (end == WR_WATCH_LOST) return wr_fail(err, "%s: its folder is gone", cli->file);
        const bool later = is_another(cli, stamp, last);
        if (other || later) return true;
    }
}

/* Repeat export_once. After a failure the next try waits for a change of one of the files. */
static int export_again(const WrCli *cli, Last *last)
{
    const int count = last->inputs.count;
    WrFileIdentity *stamps = wr_alloc((size_t)count + 1, sizeof *stamps);
    for (int i = 0; i < count; i++) stamps[i] = wr_file_identity(last->inputs.data[i].path);
    const int status = export_once(cli, last);
    for (int i = 0; last->unread && i < count; i++) last->inputs.data[i].stamp = stamps[i];
    wr_free(stamps);
    return status;
}

/* An error in FILE does not end watching: the last written files stay, and FILE is read again when it changes. An
   error in the shell line ends it, at the first try. */
static bool goes_on(const WrCli *cli, const Last *last, int status)
{
    if (status == WR_EXIT_DONE) return true;
    if (status != WR_EXIT_FAILED) return false;
    return last->written || (last->unread && wr_file_identity(cli->file).there);
}

static int watch_file(const WrCli *cli)
{
    WrError err;
    WrWatch *watch = wr_watch_new(cli->file);
    WrFileIdentity stamp = wr_file_identity(cli->file);
    Last last = { 0 };
    if (!watch) {
        wr_fail(&err, "%s: cannot be watched (%s)", cli->file, strerror(errno));
        return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    int status = export_once(cli, &last);
    while (goes_on(cli, &last, status)) {
        for (int i = 0; i < last.inputs.count; i++) wr_watch_add(watch, last.inputs.data[i].path);
        wr_cli_note(status == WR_EXIT_DONE
                        ? "watching: writes again when the file changes; an interrupt ends it"
                        : "watching: the files written last stay; tries again when the file "
                          "changes; an interrupt ends it");
        if (!wait_for_change(cli, watch, &stamp, &last, &err))
            status = wr_cli_fail(cli, WR_EXIT_FAILED, &err);
        else status = export_again(cli, &last);
    }
    forget_inputs(&last);
    wr_watch_free(watch);
    return status;
}

/* ---- several inputs ---- */

/* Ending of a file whose name is not given. */
static const char *ending_of(const WrCli *cli)
{
    const WrExportKind *kind = wr_export_find(cli->kind);
    bool floats = kind && kind->floats;
    if (cli->format) return cli->format;
    for (int i = 0; i < cli->word_count; i++) floats |= strcmp(cli->words[i], "depth=32") == 0;
    return kind && kind->ending ? kind->ending : floats ? "exr" : "png";
}

/* One input of several. */
typedef struct Item {
    WrCli cli; /* the line with this input, its output and a pool of its own */
    char *out; /* owned */
    WrText report;
    WrError err;
    bool ended, good;
} Item;

typedef struct Batch {
    const WrCli *cli;
    Item *items;
    int count, printed, failed;
    int threads;  /* of each pool */
    WrMutex lock; /* guards ended, printed, failed */
    int status;   /* of printing */
} Batch;

/* Print the results so far, in the order of the inputs. */
static void print_ended(Batch *batch)
{
    for (; batch->printed < batch->count && batch->items[batch->printed].ended; batch->printed++) {
        Item *item = &batch->items[batch->printed];
        if (item->good && batch->status == WR_EXIT_DONE)
            batch->status = wr_cli_report(batch->cli, &item->report);
        if (!item->good) batch->failed++;
        if (!item->good && !wr_cancel_requested(batch->cli->cancel))
            wr_cli_fail(batch->cli, WR_EXIT_FAILED, &item->err);
    }
}

static void export_item(int index, int worker, void *ctx)
{
    Batch *batch = ctx;
    Item *item = &batch->items[index];
    Last last = { 0 };
    (void)worker;
    /* the pool reports the finished inputs, not the work inside each */
    const WrProgress quiet = { .cancel = (volatile int *)batch->cli->cancel };
    const WrProgress *before = wr_progress_set(&quiet);
    item->cli.pool = wr_pool_new(batch->threads);
    item->good = export_as(&item->cli, &last, &item->report, &item->err);
    if (!item->good && strncmp(item->err.text, item->cli.file, strlen(item->cli.file)) != 0)
        wr_error_prefix(&item->err, "%.120s: ", item->cli.file);
    wr_pool_free(item->cli.pool);
    forget_inputs(&last);
    wr_progress_set(before);
    wr_mutex_lock(&batch->lock);
    item->ended = true;
    print_ended(batch);
    wr_mutex_unlock(&batch->lock);
}

/* Name of the output without folder and ending; a set makes its files' names of it. */
static void stem_of(const char *file, WrText *stem)
{
    wr_text_clear(stem);
    wr_map_set_cell_name(file, stem);
}

/* Check that no two inputs have the same output, and that no output is an input. */
static bool check_items(const Batch *batch, WrError *err)
{
    WrText stem = { 0 }, other = { 0 };
    bool good = true;
    for (int i = 0; i < batch->count && good; i++) {
        const Item *item = &batch->items[i];
        const WrFileIdentity out = wr_file_identity(item->out);
        stem_of(item->cli.file, &stem);
        for (int k = 0; k < batch->count && good; k++) {
            const char *file = batch->items[k].cli.file;
            const WrFileIdentity in = wr_file_identity(file);
            stem_of(file, &other);
            if (k < i && strcmp(wr_text_get(&stem), wr_text_get(&other)) == 0)
                good =
                    wr_fail(err,
                            "%.100s and %.100s: both would be written as %.60s: export them into "
                            "two folders",
                            file, item->cli.file, wr_text_get(&stem));
            else if (wr_export_find(batch->cli->kind) && wr_file_identity_same(&in, &out) &&
                     in.there)
                good = wr_fail(err, "%.200s: is an input: choose another folder or --format",
                               item->out);
        }
    }
    wr_text_fini(&stem);
    wr_text_fini(&other);
    return good;
}

/* The outputs: files in the folder, or of a set the folder itself. */
static void name_items(Batch *batch)
{
    const WrCli *cli = batch->cli;
    const bool single = wr_export_find(cli->kind) != NULL;
    WrText name = { 0 };
    for (int i = 0; i < batch->count; i++) {
        Item *item = &batch->items[i];
        stem_of(cli->files[i], &name);
        wr_text_addf(&name, ".%s", ending_of(cli));
        item->out = single ? wr_path_join(cli->out, wr_text_get(&name)) : wr_strdup(cli->out);
        item->cli = *cli;
        item->cli.file = cli->files[i];
        item->cli.out = item->out;
    }
    wr_text_fini(&name);
}

static int finish_batch(const Batch *batch)
{
    WrError err;
    if (wr_cancel_requested(batch->cli->cancel)) {
        wr_fail(&err, "interrupted");
        return wr_cli_fail(batch->cli, WR_EXIT_FAILED, &err);
    }
    if (!batch->failed) return batch->status;
    wr_fail(&err, "%d of %d files failed, the others are written", batch->failed, batch->count);
    return batch->count > 1 ? wr_cli_fail(batch->cli, WR_EXIT_FAILED, &err) : WR_EXIT_FAILED;
}

static int export_several(const WrCli *cli)
{
    WrError err;
    const int jobs = cli->jobs < cli->file_count ? cli->jobs : cli->file_count;
    const int threads = wr_pool_threads(cli->pool) / (jobs > 0 ? jobs : 1);
    Batch batch = { .cli = cli, .count = cli->file_count, .threads = threads > 0 ? threads : 1 };
    if (!wr_path_is_folder(cli->out)) {
        wr_fail(&err, "-o %.200s: is not a folder: the files need an existing folder", cli->out);
        return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    batch.items = wr_alloc((size_t)batch.count, sizeof *batch.items);
    wr_mutex_init(&batch.lock);
    name_items(&batch);
    int status = WR_EXIT_USAGE;
    if (!check_items(&batch, &err)) {
        wr_cli_fail(cli, status, &err);
    } else {
        WrPool *pool = wr_pool_new(jobs > 0 ? jobs : 1);
        wr_pool_run_with_progress(pool, batch.count, export_item, &batch);
        wr_pool_free(pool);
        status = finish_batch(&batch);
    }
    for (int i = 0; i < batch.count; i++) {
        wr_text_fini(&batch.items[i].report);
        wr_free(batch.items[i].out);
    }
    wr_mutex_fini(&batch.lock);
    wr_free(batch.items);
    return status;
}

/* ---- the subcommand ---- */

static int export_single(const WrCli *cli)
{
    Last last = { 0 };
    const int status = export_once(cli, &last);
    forget_inputs(&last);
    return status;
}

/* True if -o names a folder for files of one kind. */
static bool into_folder(const WrCli *cli)
{
    const size_t length = strlen(cli->out);
    return cli->file_count > 1 || (cli->file_count == 1 && wr_export_find(cli->kind) &&
                                   (cli->out[length - 1] == '/' || wr_path_is_folder(cli->out)));
}

/* Check the required options. */
static bool check_needs(const WrCli *cli, WrError *err)
{
    char ending[16] = "";
    const bool body = cli->out && wr_export_find(wr_path_ending(cli->out, ending));
    if (!cli->kind)
        return wr_fail(err, "export: needs --as KIND%s%s", body ? ", here --as " : "",
                       body ? ending : "");
    if (!cli->out && cli->file_count == 2)
        return wr_fail(err, "export: needs -o OUT: did you mean -o %.100s?", cli->files[1]);
    if (!cli->out) return wr_fail(err, "export: needs -o OUT");
    if (cli->watch && !cli->file) return wr_fail(err, "export: needs FILE to watch");
    return true;
}

/* Check the combination of options. */
static bool check_line(const WrCli *cli, WrError *err)
{
    if (!check_needs(cli, err)) return false;
    if (cli->watch && cli->file_count > 1)
        return wr_fail(err, "export: --watch is of one file, and these are %d", cli->file_count);
    if (wr_cli_to_stdout(cli)) {
        if (cli->watch) return wr_fail(err, "export: --watch needs the name of a file, not -o -");
        if (cli->file_count > 1)
            return wr_fail(err, "export: -o - holds one file, and these are %d: name a folder",
                           cli->file_count);
        if (!wr_export_find(cli->kind) && is_set(cli->kind))
            return wr_fail(err,
                           "export: -o - holds one file, and %.40s is a set of several: name "
                           "a folder",
                           cli->kind);
        return true;
    }
    if (cli->watch && into_folder(cli))
        return wr_fail(err, "export: --watch needs the name of a file, not of a folder");
    if (cli->format && !(into_folder(cli) && wr_export_find(cli->kind)))
        return wr_fail(err,
                       "export: --format goes with -o - or -o FOLDER/; the format of %.100s goes "
                       "by its ending",
                       cli->out);
    return true;
}

int wr_cli_export(const WrCli *cli)
{
    WrError err;
    if (!check_line(cli, &err)) return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    if (cli->watch) return watch_file(cli);
    if (wr_cli_to_stdout(cli)) return wr_cli_pipe(cli, ending_of(cli), export_single);
    return into_folder(cli) ? export_several(cli) : export_single(cli);
}
