#include "base/memory.h"
#include "cli/cli.h"
#include "command/recovery.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static void add_time(WrText *text, double seconds)
{
    time_t when = (time_t)seconds;
    struct tm parts;
    char line[32] = "?";
    if (localtime_r(&when, &parts)) strftime(line, sizeof line, "%Y-%m-%d %H:%M:%S", &parts);
    wr_text_add(text, line);
}

static void add_json(WrText *text, const WrRecoverable *r)
{
    wr_text_add(text, "{\"journal\":");
    wr_text_add_json_string(text, r->journal);
    wr_text_add(text, ",\"document\":");
    wr_text_add_json_string(text, r->document);
    wr_text_addf(
        text,
        ",\"started\":%.0f,\"written\":%.0f,\"commands\":%d,\"damaged\":%s,\"unfinished\":%s}\n",
        r->started, r->written, r->commands, r->damaged ? "true" : "false",
        r->unfinished ? "true" : "false");
}

static int list(const WrCli *cli, const WrRecoverable *found, int count)
{
    WrText text = { 0 };
    for (int i = 0; i < count; i++) {
        const WrRecoverable *r = &found[i];
        if (cli->json) {
            add_json(&text, r);
            continue;
        }
        wr_text_addf(&text, "%d  %s  %d commands%s%s, last change ", i + 1,
                     r->document[0] ? r->document : "(never saved)", r->commands,
                     r->unfinished ? ", one that did not end" : "",
                     r->damaged ? ", damaged at the end" : "");
        add_time(&text, r->written);
        wr_text_addf(&text, "\n   %s\n", r->journal);
    }
    if (count == 0 && !cli->json) wr_text_add(&text, "nothing to recover\n");
    int status = wr_cli_print(cli, &text);
    wr_text_fini(&text);
    return status;
}

/* The journal that a word means: its number in the list, or its path. */
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

static bool recover_one(const WrCli *cli, const char *journal, WrError *err)
{
    WrText report = { 0 };
    WrSession *session = wr_cli_session(cli, false, err);
    if (session) wr_session_set_journal(session, true);
    bool recovered = session && wr_session_recover(session, journal, &report, err);
    bool good = recovered && wr_session_save(session, cli->out, err);
    if (recovered && !good) wr_session_journal_leave(session); /* it holds the work still */
    fputs(wr_text_get(&report), stderr);
    wr_text_fini(&report);
    wr_session_free(session);
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
        else if (good && !cli->out)
            good = wr_fail(&err, "recover %s: needs -o FILE.exr to save the document to", word);
        else if (good) good = recover_one(cli, journal, &err);
        if (!good) status = wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    }
    wr_recovery_list_free(found, count);
    return status;
}
