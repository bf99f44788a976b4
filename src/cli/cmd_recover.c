#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "cli/cli.h"
#include "command/recovery.h"
#include "command/session.h"
#include "system/clock.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static void add_time(WrText *text, double seconds)
{
    time_t when = (time_t)seconds;
    struct tm parts;
    char line[32] = "?";
    if (wr_clock_local(when, &parts)) strftime(line, sizeof line, "%Y-%m-%d %H:%M:%S", &parts);
    wr_text_add(text, line);
}

static void add_json(WrText *text, const WrRecoverable *r)
{
    wr_text_add(text, "{\"journal\":");
    wr_text_add_json_string(text, r->journal);
    wr_text_add(text, ",\"document\":");
    wr_text_add_json_string(text, r->document);
    wr_text_addf(text,
                 ",\"started\":%.0f,\"written\":%.0f,\"commands\":%d,\"beyond\":%d,\"lost\":%d,"
                 "\"headless\":%s,\"damaged\":%s,\"unfinished\":%s",
                 r->started, r->written, r->commands, r->beyond, r->lost,
                 r->headless ? "true" : "false", r->damaged ? "true" : "false",
                 r->unfinished ? "true" : "false");
    if (r->error) {
        wr_text_add(text, ",\"error\":");
        wr_text_add_json_string(text, r->error);
    }
    wr_text_add(text, "}");
}

static void add_line(WrText *text, int number, const WrRecoverable *r)
{
    wr_text_addf(text, "%d  ", number);
    if (r->error) {
        wr_text_add(text, "(cannot be read), last change ");
        add_time(text, r->written);
        wr_text_addf(text, "\n   %s\n", r->error);
        return;
    }
    wr_text_addf(text, "%s  %d commands%s", r->document[0] ? r->document : "(never saved)",
                 r->commands, r->unfinished ? ", one that did not end" : "");
    if (r->damaged)
        wr_text_addf(text, ", damaged: %d lines lost, %d commands behind it", r->lost, r->beyond);
    if (r->headless) wr_text_add(text, ", its start is unknown");
    wr_text_add(text, ", last change ");
    add_time(text, r->written);
    wr_text_addf(text, "\n   %s\n", r->journal);
}

static int list(const WrCli *cli, const WrRecoverable *found, int count)
{
    WrText text = { 0 };
    if (cli->json) wr_text_add(&text, "[");
    for (int i = 0; i < count; i++) {
        if (cli->json) wr_text_add(&text, i ? ",\n" : "");
        if (cli->json) add_json(&text, &found[i]);
        else add_line(&text, i + 1, &found[i]);
    }
    if (cli->json) wr_text_add(&text, "]\n");
    else if (count == 0) wr_text_add(&text, "nothing to recover\n");
    int status = wr_cli_print(cli, &text);
    wr_text_fini(&text);
    return status;
}

/* Journal of a word: its number in the list, or its path. */
static const char *chosen(const char *word, const WrRecoverable *found, int count, WrError *err)
{
    char *end;
    long number = strtol(word, &end, 10);
    if (*end == '\0' && number >= 1 && number <= count) return found[number - 1].journal;
    for (int i = 0; i < count; i++)
        if (strcmp(found[i].journal, word) == 0) return word;
    wr_fail(err, "recover %s: must be a number of the list or the path of a journal; there are %d",
            word, count);
    return NULL;
}

/* Print each line as a note. */
static void print_notes(const WrText *text)
{
    for (const char *at = wr_text_get(text); *at;) {
        int length = (int)strcspn(at, "\n");
        fprintf(stderr, "wrinkle: note: %.*s\n", length, at);
        at += length + (at[length] == '\n');
    }
}

/* Recovery was incomplete: the journal stays; print the options for it. */
static bool report_rest(const char *word, WrRecovered *recovered, WrError *err)
{
    WrText *report = &recovered->report;
    if (recovered->more)
        wr_text_addf(report, "`wrinkle recover %s --beyond -o OUT` goes on with what follows\n",
                     word);
    wr_text_addf(
        report,
        "`wrinkle recover %s --script -o OUT.wrinkle` writes all that can be read as text\n"
        "`wrinkle recover discard %s` removes it\n",
        word, word);
    return wr_fail(err, "recover %.100s: %d of %d commands were recovered; the journal was kept",
                   word, recovered->done, recovered->commands);
}

static bool recover_one(const WrCli *cli, const char *journal, const char *path, WrError *err)
{
    WrRecovered recovered = { 0 };
    WrSession *session = wr_cli_session(cli, false, err);
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.8);
    bool good = session && wr_session_recover(session, journal, cli->beyond, &recovered, err);
    wr_progress_set(whole);
    wr_progress_enter(&part, 0.8, 1.0);
    good = good && wr_session_save(session, path, err) &&
           wr_recovered_saved(&recovered, session, path, err);
    wr_progress_set(whole);
    wr_cli_progress_clear();
    if (!good && wr_progress_stopped())
        wr_text_addf(&recovered.report, "%s was kept whole: recover it another time\n", journal);
    if (good && !recovered.whole) good = report_rest(cli->words[0], &recovered, err);
    print_notes(&recovered.report);
    wr_recovered_fini(&recovered);
    wr_session_free(session);
    return good;
}

static bool write_script(const WrCli *cli, const char *journal, WrError *err)
{
    WrText text = { 0 };
    bool good = wr_recovery_script(journal, &text, err);
    if (good && cli->out) good = wr_file_write(cli->out, wr_text_get(&text), text.length, err);
    else if (good) good = wr_cli_print(cli, &text) == WR_EXIT_DONE || wr_fail(err, "not written");
    wr_text_fini(&text);
    return good;
}

static bool bring_back(const WrCli *cli, const char *journal, WrError *err)
{
    WrText own = { 0 };
    const char *word = cli->words[0];
    if (cli->script) return write_script(cli, journal, err);
    if (!cli->out && !cli->in_place)
        return wr_fail(
            err,
            "recover %s: needs -o FILE.exr to save the document to, or --in-place to save "
            "it to its own file",
            word);
    if (cli->out && cli->in_place)
        return wr_fail(err, "recover %s: -o and --in-place: only one of them", word);
    bool good = cli->out || wr_recovery_own_file(journal, &own, err);
    if (!good) wr_error_prefix(err, "recover %s --in-place: ", word);
    good = good && recover_one(cli, journal, cli->out ? cli->out : wr_text_get(&own), err);
    wr_text_fini(&own);
    return good;
}

int wr_cli_recover(const WrCli *cli)
{
    WrError err = { "" };
    WrRecoverable *found = NULL;
    int count = 0, status = WR_EXIT_DONE;
    if (!wr_recovery_list(&found, &count, &err)) return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    const bool discard = cli->word_count > 0 && strcmp(cli->words[0], "discard") == 0;
    const char *word = cli->word_count > discard ? cli->words[discard] : NULL;
    if (!word) {
        status = list(cli, found, count);
    } else {
        const char *journal = chosen(word, found, count, &err);
        bool good = journal;
        if (good && discard) good = wr_recovery_discard(journal, &err);
        else if (good) good = bring_back(cli, journal, &err);
        if (!good) status = wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    wr_recovery_list_free(found, count);
    return status;
}
