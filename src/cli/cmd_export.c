#include "cli/cli.h"

#include "base/array.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/file.h"
#include "base/text.h"
#include "command/session.h"
#include "command/variants.h"
#include "export/export.h"
#include "export/map_sets.h"
#include "system/file_watch.h"

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
    const bool good = out && wr_session_check_export(export->session, export->kind, out, err) &&
                      wr_export(export->kind, wr_session_document(export->session), export->options,
                                export->cli->pool, out, &written, err);
    if (good) {
        wr_text_addf(export->report, "%s: ", out);
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
    const WrMapSetRequest order = { export->set, folder, cell, words, count };
    const bool good = wr_export_map_set(&order, wr_session_document(export->session), cli->pool,
                                        export->report, err);
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

static bool export_as(const WrCli *cli, Last *last, WrText *report, WrError *err)
{
    const WrExportKind *kind = wr_export_find(cli->kind);
    if (kind) return export_file(cli, kind, last, report, err);
    if (!is_set(cli->kind)) return fail_unknown(cli->kind, err);
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
        status = wr_cli_print(cli, &report);
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

/* Wait until no change has come for SETTLE_SECONDS; a file that another program still writes is empty or in part. */
static WrWatchEnd settle(const WrCli *cli, WrWatch *watch)
{
    WrWatchEnd end;
    do end = wr_watch_wait(watch, SETTLE_SECONDS);
    while (end == WR_WATCH_CHANGED && !is_cancelled(cli));
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

int wr_cli_export(const WrCli *cli)
{
    WrError err;
    Last last = { 0 };
    if (!cli->kind || !cli->out || (cli->watch && !cli->file)) {
        char ending[16] = "";
        const bool body = cli->out && wr_export_find(wr_path_ending(cli->out, ending));
        wr_fail(&err, "export: needs %s%s%s",
                !cli->kind  ? "--as KIND"
                : !cli->out ? "-o OUT"
                            : "FILE to watch",
                !cli->kind && body ? ", here --as " : "", !cli->kind && body ? ending : "");
        return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    }
    return cli->watch ? watch_file(cli) : export_once(cli, &last);
}
