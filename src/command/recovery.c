#include "command/recovery.h"
#include "command/inner.h"

#include "base/memory.h"
#include "document/document_file.h"
#include "document/recover.h"

#include <string.h>

#define TRIAL_SECONDS 60.0

bool wr_recovery_list(WrRecoverable **list, int *count, WrError *err)
{
    WrJournalList journals = { 0 };
    if (!wr_journal_list(NULL, &journals, err)) return false;
    WrRecoverable *out = wr_alloc((size_t)journals.count + 1, sizeof *out);
    int n = 0;
    for (int i = 0; i < journals.count; i++) {
        const WrJournalEntry *e = &journals.entries[i];
        if (e->error[0] || e->nothing) continue;
        out[n++] = (WrRecoverable){ .journal = wr_strdup(e->path),
                                    .document = wr_strdup(e->document),
                                    .started = (double)e->started,
                                    .written = (double)e->written,
                                    .commands = e->complete,
                                    .damaged = e->dropped_bytes > 0,
                                    .unfinished = e->unfinished };
    }
    wr_journal_list_fini(&journals);
    *list = out;
    *count = n;
    return true;
}

void wr_recovery_list_free(WrRecoverable *list, int count)
{
    for (int i = 0; i < count; i++) {
        wr_free(list[i].journal);
        wr_free(list[i].document);
    }
    wr_free(list);
}

bool wr_recovery_discard(const char *journal, WrError *err)
{
    WrJournalClaim *claim = wr_journal_claim(journal, err);
    return claim && wr_journal_claim_remove(claim, err);
}

/* The state that the journal's first command ran on. */
static bool bring_start(WrSession *session, const char *journal, const WrJournalStart *start,
                        WrError *err)
{
    if (start->kind == WR_JOURNAL_EMPTY) return true;
    if (start->kind == WR_JOURNAL_SNAPSHOT) {
        if (!wr_session_load(session, start->snapshot, err)) return false;
    } else {
        WrText kept = { 0 };
        bool copy =
            start->sha256 && wr_journal_kept_file(journal, start->sha256, start->path, &kept, NULL);
        bool good = wr_session_load(session, copy ? wr_text_get(&kept) : start->path, err);
        wr_text_fini(&kept);
        if (!good) return false;
    }
    static const WrHash none;
    if (!wr_hash_equal(start->hash, none) && !wr_hash_equal(start->hash, wr_session_hash(session)))
        return wr_fail(err, "%s: is not what the journal began with: it was changed since",
                       start->path ? start->path : "the snapshot");
    return true;
}

typedef struct Try {
    WrSession *session;
    const char *line;
} Try;

static bool try_line(void *ctx, WrError *err)
{
    Try *attempt = ctx;
    attempt->session->options.pool = NULL; /* the child has only this thread */
    return wr_session_run(attempt->session, attempt->line, err);
}

/* The command that never ended: is it safe to run? */
static bool last_is_safe(WrSession *session, const char *line, WrText *report)
{
    WrError why = { "" };
    Try attempt = { session, line };
    switch (wr_journal_trial(try_line, &attempt, TRIAL_SECONDS, 0, &why)) {
    case WR_TRIAL_TRUE: return true;
    case WR_TRIAL_FALSE:
        wr_text_addf(report, "the last command failed and was left out: %s\n", why.text);
        return false;
    default:
        wr_text_addf(report,
                     "stopped before the last command, which may be what crashed (%s): %.200s\n",
                     why.text, line);
        return false;
    }
}

/* The line with files that have changed or gone since replaced by the journal's copies. Caller frees. */
static char *with_copies(const char *journal, const char *line)
{
    WrCall *call = NULL;
    WrText text = { 0 }, copy = { 0 };
    if (!wr_call_parse(line, false, &call, NULL)) return wr_strdup(line);
    for (int i = 0; i < call->count; i++) {
        char hex[65];
        const char *name = call->args[i].text, *hash = wr_call_hash_name(call, i);
        if (!hash || !wr_call_given(call, hash) || !wr_call_names_file(call, i)) continue;
        const char *sha256 = wr_call_arg(call, hash)->text;
        if (wr_sha256_file(name, hex, NULL) && strcmp(hex, sha256) == 0) continue;
        wr_text_clear(&copy);
        if (wr_journal_kept_file(journal, sha256, name, &copy, NULL))
            wr_call_set_text(call, call->specs[i].name, wr_text_get(&copy));
    }
    wr_call_print(call, &text);
    wr_call_free(call);
    wr_text_fini(&copy);
    char *out = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return out;
}

static void run_lines(WrSession *session, const char *journal, const WrJournalRead *read,
                      WrText *report)
{
    WrError why = { "" };
    int done = 0;
    for (int i = 0; i < read->count; i++) {
        const WrJournalLine *line = &read->lines[i];
        bool last = read->unfinished && i == read->count - 1;
        /* A stroke that was being drawn had already run as far as its samples go. */
        char *text = with_copies(journal, line->text);
        bool stop = last && !read->in_stroke && !last_is_safe(session, text, report);
        bool good = stop || wr_session_run(session, text, &why);
        wr_free(text);
        if (stop) break;
        if (!good) {
            wr_text_addf(report, "command %d failed, and what came after it is lost: %s\n", i + 1,
                         why.text);
            break;
        }
        if (line->hashed && !wr_hash_equal(line->hash, wr_session_hash(session)))
            wr_text_addf(report, "command %d gave another result than it did at first\n", i + 1);
        done++;
    }
    wr_text_addf(report, "%d of %d commands were brought back\n", done, read->count);
    if (read->dropped_bytes)
        wr_text_addf(report, "the journal's end is damaged; %lld bytes were dropped (%s)\n",
                     (long long)read->dropped_bytes, read->damage);
    if (read->gap[0])
        wr_text_addf(report, "what came after is not in the journal: %s\n", read->gap);
}

/* Replay into the session, whose old state is kept aside by the caller. */
static bool replay(WrSession *session, const char *journal, const WrJournalRead *read,
                   WrText *report, WrError *err)
{
    session->opening = true;
    bool good = bring_start(session, journal, &read->start, err);
    if (good) wr_session_rebase(session);
    if (good) run_lines(session, journal, read, report);
    session->opening = false;
    return good;
}

bool wr_session_recover(WrSession *session, const char *journal, WrText *report, WrError *err)
{
    WrJournalRead read = { 0 };
    if (!wr_session_refuse_in_stroke(session, err)) return false;
    WrJournalClaim *claim = wr_journal_claim(journal, err);
    if (!claim) return false;
    if (!wr_journal_read(journal, &read, err)) {
        wr_journal_claim_free(claim);
        return false;
    }
    WrSessionState old = wr_session_begin_state(session, wr_document_new());
    bool good = replay(session, journal, &read, report, err);
    if (!good) {
        wr_session_restore_state(session, &old);
        wr_journal_claim_free(claim);
    } else {
        WrError trouble = { "" };
        wr_session_keep_state(session, &old);
        session->state.path = wr_strdup(read.start.path);
        session->state.saved_revision = UINT64_MAX; /* no state of it was ever saved */
        wr_session_journal_drop(session);
        /* The old journal goes only when the new one holds it all. */
        if (wr_session_journal_anew(session, &trouble)) wr_journal_claim_remove(claim, NULL);
        else {
            wr_text_addf(report, "the old journal was kept: %s\n", trouble.text);
            wr_journal_claim_free(claim);
        }
    }
    wr_journal_read_fini(&read);
    return good;
}
