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

/* Neither kind nor set. */
static bool fail_unknown(const char *name, WrError *err)
{
    WrText names = { 0 };
    WrSetNames sets = wr_set_names();
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        wr_text_addf(&names, "%s%s", i ? ", " : "", wr_export_kinds[i].name);
    for (int i = 0; i < sets.names.count; i++)
        wr_text_addf(&names, "%s%s", i ? ", " : "; or a set: ", sets.names.data[i]);
    wr_fail(err, "--as %.60s: unknown kind: must be one of %s", name, wr_text_get(&names));
    wr_text_fini(&names);
    wr_set_names_free(&sets);
    return false;
}

static bool export_file(const WrCli *cli, const WrExportKind *kind, WrText *report, WrError *err)
{
    WrExportOptions options = wr_export_default();
    WrExportReport written;
    if (!read_options(cli, kind, &options, err)) return false;
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

static bool export_maps(const WrCli *cli, const WrSet *set, WrText *report, WrError *err)
{
    WrSession *session = wr_cli_load(cli, false, err);
    if (!session) return false;
    WrText name = { 0 };
    wr_set_cell_name(cli->file, &name);
    WrSetOrder order = { set, cli->out, wr_text_get(&name), cli->words, cli->word_count };
    bool good = wr_export_set(&order, wr_session_document(session), cli->pool, report, err);
    wr_text_fini(&name);
    wr_session_free(session);
    return good;
}

static bool is_set(const char *name)
{
    WrSetNames sets = wr_set_names();
    bool found = false;
    for (int i = 0; i < sets.names.count; i++) found |= strcmp(sets.names.data[i], name) == 0;
    wr_set_names_free(&sets);
    return found;
}

static bool export_as(const WrCli *cli, WrText *report, WrError *err)
{
    const WrExportKind *kind = wr_export_find(cli->kind);
    if (kind) return export_file(cli, kind, report, err);
    if (!is_set(cli->kind)) return fail_unknown(cli->kind, err);
    WrSet *set = wr_set_find(cli->kind, err);
    bool good = set && export_maps(cli, set, report, err);
    wr_set_free(set);
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
    int status = export_as(cli, &report, &err) ? wr_cli_print(cli, &report)
                                               : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_text_fini(&report);
    return status;
}
