#include "cli/cli.h"

#include "base/error.h"
#include "base/text.h"
#include "command/session.h"
#include "export/export.h"
#include "export/sets.h"

#include <string.h>

static bool read_options(const WrCli *cli, const WrExportKind *kind, WrExportOptions *options,
                         WrError *err)
{
    for (int i = 0; i < cli->word_count; i++) {
        const char *word = cli->words[i], *value = strchr(word, '=') + 1;
        WrText name = { 0 };
        wr_text_add_n(&name, word, (size_t)(value - 1 - word));
        for (int k = 0; k < i; k++)
            if (strncmp(cli->words[k], word, name.length + 1) == 0) {
                wr_fail(err, "%s= is given twice", wr_text_get(&name));
                wr_text_fini(&name);
                return false;
            }
        bool good = wr_export_option(kind, options, wr_text_get(&name), value, err);
        wr_text_fini(&name);
        if (!good) return false;
    }
    return true;
}

static bool find_kind(const char *name, const WrExportKind **kind, WrError *err)
{
    *kind = wr_export_find(name);
    if (*kind) return true;
    WrText names = { 0 };
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        wr_text_addf(&names, "%s%s", i ? ", " : "", wr_export_kinds[i].name);
    for (int i = 0; i < WR_EXPORT_SET_COUNT; i++)
        wr_text_addf(&names, "%s%s", i ? ", " : "; or a set: ", wr_export_sets[i].name);
    wr_fail(err, "--as %.60s: unknown kind: must be one of %s", name, wr_text_get(&names));
    wr_text_fini(&names);
    return false;
}

static bool export_file(const WrCli *cli, WrText *report, WrError *err)
{
    const WrExportKind *kind;
    WrExportOptions options = wr_export_default();
    WrExportReport written;
    if (!find_kind(cli->kind, &kind, err) || !read_options(cli, kind, &options, err)) return false;
    WrSession *session = wr_cli_load(cli, false, err);
    if (!session) return false;
    bool good =
        wr_export(kind, wr_session_document(session), &options, cli->pool, cli->out, &written, err);
    if (good) {
        wr_text_addf(report, "%s: ", cli->out);
        wr_export_report_text(&written, report);
        wr_text_add(report, "\n");
    }
    wr_session_free(session);
    return good;
}

/* The document's name without folder and ending; without a document the program's. */
static void cell_name(const WrCli *cli, WrText *name)
{
    const char *file = cli->file ? cli->file : "wrinkle", *slash = strrchr(file, '/');
    const char *base = slash ? slash + 1 : file, *dot = strrchr(base, '.');
    wr_text_add_n(name, base, dot && dot > base ? (size_t)(dot - base) : strlen(base));
}

static bool export_maps(const WrCli *cli, const WrExportSet *set, WrText *report, WrError *err)
{
    WrSession *session = wr_cli_load(cli, false, err);
    if (!session) return false;
    WrText name = { 0 };
    cell_name(cli, &name);
    WrSetOrder order = { set, cli->out, wr_text_get(&name), cli->words, cli->word_count };
    bool good = wr_export_set(&order, wr_session_document(session), cli->pool, report, err);
    wr_text_fini(&name);
    wr_session_free(session);
    return good;
}

int wr_cli_export(const WrCli *cli)
{
    WrError err;
    WrText report = { 0 };
    if (!cli->kind || !cli->out) {
        wr_fail(&err, "export: needs %s", cli->kind ? "-o OUT" : "--as KIND");
        return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    }
    const WrExportSet *set = wr_export_set_find(cli->kind);
    bool good = set ? export_maps(cli, set, &report, &err) : export_file(cli, &report, &err);
    int status = good ? wr_cli_print(cli, &report) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&report);
    return status;
}
