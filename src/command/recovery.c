/* Crash recovery: the list of documents that can be recovered, and the recovery of one. */
#include "command/recovery.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/progress.h"
#include "command/session_internal.h"
#include "document/recover.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* ---- List of recoverable documents ---- */

/* View commands after a save are not lost work. */
static bool changes_document(const char *line)
{
    WrCall *call = NULL;
    if (!wr_call_parse(line, false, &call, NULL)) return true;
    bool view = call->command && wr_call_of_views(call);
    wr_call_free(call);
    return !view;
}

bool wr_recovery_list(WrRecoverable **list, int *count, WrError *err)
{
    WrJournalList journals = { 0 };
    if (!wr_journal_list_that(NULL, changes_document, &journals, err)) return false;
    WrRecoverable *out = wr_alloc((size_t)journals.count + 1, sizeof *out);
    int n = 0;
    for (int i = 0; i < journals.count; i++) {
        const WrJournalEntry *e = &journals.entries[i];
        if (e->nothing) continue;
        out[n++] = (WrRecoverable){ .journal = wr_strdup(e->path),
                                    .document = wr_strdup(e->document),
                                    .started = (double)e->started,
                                    .written = (double)e->written,
                                    .commands = e->complete,
                                    .beyond = e->beyond,
                                    .lost = e->lost,
                                    .headless = e->headless,
                                    .damaged = e->dropped_bytes > 0 || e->error[0],
                                    .unfinished = e->unfinished,
                                    .error = e->error[0] ? wr_strdup(e->error) : NULL };
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
        wr_free(list[i].error);
    }
    wr_free(list);
}

bool wr_recovery_discard(const char *journal, WrError *err)
{
    WrJournalClaim *claim = wr_journal_claim(journal, err);
    return claim && wr_journal_claim_remove(claim, err);
}

/* ---- recovery ---- */

#define TRIAL_SECONDS 60.0
#define START_PART 0.1   /* share of the work: loading the start state */
#define SENTENCES_MAX 20 /* about single commands; further ones are counted */

/* ---- one replay ---- */

typedef struct Replay {
    WrSession *session;
    const char *journal;
    const WrJournalRead *read;
    bool beyond;
    bool saved;                /* starts from the last saved file */
    int from, end;             /* lines[from..end) will run */
    int done;                  /* lines that have run */
    bool cut;                  /* the last command was left out though it may have completed */
    bool known;                /* the start state is verified */
    bool missing;              /* steps are missing: */
    int floor, ceiling;        /* history positions that undo and redo may still reach */
    bool differs;              /* a difference was reported */
    int sentences;             /* about single commands */
    WrText *messages, dropped; /* sentences; those beyond SENTENCES_MAX */
} Replay;

/* The text that the next sentence is appended to: each is a message on a line of its own. */
static WrText *sentence(WrText *messages)
{
    if (messages->length > 0) wr_text_add(messages, "\n");
    return messages;
}

/* The same for sentences about single commands, of which there may be very many. */
static WrText *command_sentence(Replay *r)
{
    return sentence(r->sentences++ < SENTENCES_MAX ? r->messages : &r->dropped);
}

/* Mark a possible gap in the history: undo must not go below this position. */
static void note_missing(Replay *r)
{
    r->missing = true;
    r->floor = r->ceiling = wr_session_history_position(r->session);
}

static bool check_hash(const WrSession *session, const WrHash *hash, const char *what, WrError *err)
{
    if (wr_hash_equal(*hash, wr_session_hash(session))) return true;
    return wr_fail(err, "%s: has changed since the journal began", what);
}

/* Load the state before the journal's first command. If the first line is damaged, this is a guess. */
static bool update_start(Replay *r, WrError *err)
{
    static const WrHash none;
    const WrJournalStart *start = &r->read->start;
    const char *name = start->path ? start->path : "the snapshot";
    if (start->kind == WR_JOURNAL_SNAPSHOT) {
        if (!wr_session_load(r->session, start->snapshot, err)) return false;
    } else if (start->kind == WR_JOURNAL_DOCUMENT) {
        WrText kept = { 0 };
        bool copy = start->sha256 &&
                    wr_journal_find_input_copy(r->journal, start->sha256, start->path, &kept, NULL);
        bool good = wr_session_load(r->session, copy ? wr_text_get(&kept) : start->path, err);
        wr_text_fini(&kept);
        if (!good) return false;
    }
    bool hashed = !wr_hash_equal(start->hash, none);
    bool fits = hashed && check_hash(r->session, &start->hash, name, err);
    /* The hash of an empty document may differ between program versions. */
    r->known = fits || !r->read->headless;
    if (!r->read->headless) return fits || !hashed || start->kind == WR_JOURNAL_EMPTY;
    if (fits) return true;
    if (!r->beyond)
        return wr_fail(err,
                       "%s: its first line is damaged, so the start of the document is unknown",
                       r->journal);
    wr_message_addf(
        command_sentence(r),
        "the journal's first line is damaged: the document may not have started from %s",
        start->kind == WR_JOURNAL_EMPTY ? "an empty table" : name);
    note_missing(r);
    return true;
}

/* Load the last saved file, if its content is unchanged. */
static bool update_saved(Replay *r, WrError *err)
{
    const WrJournalSave *saved = &r->read->saved;
    return wr_session_load(r->session, saved->path, err) &&
           check_hash(r->session, &saved->hash, saved->path, err);
}

typedef struct Try {
    WrSession *session;
    const char *line;
} Try;

static bool try_line(void *ctx, WrError *err)
{
    Try *attempt = ctx;
    attempt->session->options.pool = NULL; /* a forked child has only this thread */
    return wr_session_run(attempt->session, attempt->line, err);
}

/* Check in a separate process that the command without a recorded end is safe to run. */
static bool last_is_safe(Replay *r, const char *line)
{
    WrError why = { "" };
    Try attempt = { r->session, line };
    switch (wr_journal_trial(try_line, &attempt, TRIAL_SECONDS, 0, &why)) {
    case WR_PROBE_TRUE: return true;
    case WR_PROBE_FALSE:
        wr_message_addf(sentence(r->messages), "the last command failed and was skipped: %s",
                        wr_error_message(&why));
        r->done++; /* it failed then as well, or would have: the document never contained it */
        return false;
    default:
        wr_message_addf(
            sentence(r->messages),
            "stopped before the last command, which may have caused the crash (%s): %.200s",
            wr_error_message(&why), line);
        r->cut = true;
        return false;
    }
}

static void take_copies(WrCall *call, void *ctx)
{
    const char *journal = ctx;
    WrText copy = { 0 };
    for (int i = 0; i < call->count; i++) {
        char hex[65];
        const char *name = call->args[i].text, *hash = wr_call_hash_argument(call, i);
        if (!hash || !wr_call_given(call, hash) || !wr_call_names_file(call, i)) continue;
        const char *sha256 = wr_call_arg(call, hash)->text;
        if (wr_input_sha256(name, hex, NULL) && strcmp(hex, sha256) == 0) continue;
        wr_text_clear(&copy);
        if (wr_journal_find_input_copy(journal, sha256, name, &copy, NULL))
            wr_call_set_text(call, call->specs[i].name, wr_text_get(&copy));
    }
    wr_text_fini(&copy);
}

/* The line with the journal's copies in place of changed or missing files. The caller frees it. */
static char *with_copies(const char *journal, const char *line)
{
    WrCall *call = NULL;
    WrText text = { 0 };
    if (!wr_call_parse(line, false, &call, NULL)) return wr_strdup(line);
    wr_call_visit(call, take_copies, (void *)journal);
    wr_call_print(call, &text);
    wr_call_free(call);
    char *out = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return out;
}

/* Step count of "undo N" or "redo N", negative for undo. 0 for any other line. */
static int travel(const char *line)
{
    WrCall *call = NULL;
    int steps = 0;
    if (!wr_call_parse(line, false, &call, NULL)) return 0;
    if (call->command && call->command->steps)
        steps = call->command->steps * (int)wr_call_number(call, "N");
    wr_call_free(call);
    return steps;
}

/* Move through the history with steps missing; refused if the target may be one of the missing steps. */
static bool go_carefully(Replay *r, int index, int steps, WrError *err)
{
    int position = wr_session_history_position(r->session), to = position + steps;
    if (to < r->floor) to = r->floor;
    if (to > r->ceiling) to = r->ceiling;
    if (to != position + steps)
        wr_message_addf(command_sentence(r),
                        "command %d, %s %d, needs missing states: %d of its steps were done",
                        index + 1, steps < 0 ? "undo" : "redo", abs(steps), abs(to - position));
    return to == position || wr_session_go_to(r->session, to, err);
}

static bool run_one(Replay *r, int index, const char *text, WrError *err)
{
    int steps = r->missing ? travel(text) : 0, before = wr_session_history_position(r->session);
    if (steps) return go_carefully(r, index, steps, err);
    if (!wr_session_run(r->session, text, err)) return false;
    int after = wr_session_history_position(r->session);
    if (after > before) r->ceiling = after; /* a step, not a view */
    return true;
}

static double done_part(const Replay *r, int index)
{
    double lines = r->end > r->from ? (double)(index - r->from) / (r->end - r->from) : 0.0;
    return START_PART + (1.0 - START_PART) * lines;
}

/* False: recovery must stop here. */
static bool replay_line(Replay *r, int index)
{
    WrError why = { "" };
    const WrJournalLine *line = &r->read->lines[index];
    bool last = r->read->unfinished && index == r->read->total - 1;
    if (line->lost) {
        wr_message_addf(command_sentence(r), "before command %d, %d lines of the journal are lost",
                        index + 1, line->lost);
        note_missing(r);
    }
    if (line->holed)
        wr_message_addf(command_sentence(r), "command %d is a stroke with lost points", index + 1);
    char *text = with_copies(r->journal, line->text);
    WrProgressPart part;
    const WrProgress *whole =
        wr_progress_enter(&part, done_part(r, index), done_part(r, index + 1));
    /* A stroke in progress is safe: its recorded samples had already been drawn. */
    bool stop = last && !r->read->in_stroke && !last_is_safe(r, text);
    bool good = stop || run_one(r, index, text, &why);
    wr_progress_set(whole);
    wr_free(text);
    if (stop || wr_progress_stopped()) return false; /* its result may be half done */
    if (!good) {
        wr_message_addf(command_sentence(r), "command %d failed%s: %s", index + 1,
                        r->beyond ? "" : ", and the later commands were left out",
                        wr_error_message(&why));
        note_missing(r);
        return r->beyond;
    }
    r->done++;
    if (line->hashed && !r->differs && !wr_hash_equal(line->hash, wr_session_hash(r->session))) {
        r->differs = true;
        wr_message_addf(command_sentence(r),
                        "from command %d on the document differs from the recorded one", index + 1);
    }
    return true;
}

/* Replay into the session, whose state is fresh. */
static bool replay(Replay *r, bool from_saved, WrError *err)
{
    const WrJournalRead *read = r->read;
    r->saved = from_saved;
    r->from = from_saved ? read->saved.at : 0;
    r->known = from_saved;
    r->session->opening = true;
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, START_PART);
    bool good = from_saved ? update_saved(r, err) : update_start(r, err);
    wr_progress_set(whole);
    if (good) wr_session_restart_history(r->session);
    r->end = r->beyond ? read->total : wr_journal_sound_end(read, r->from, r->known);
    for (int i = r->from; good && wr_progress_report(done_part(r, i)) && i < r->end;) {
        if (!replay_line(r, i)) break;
        i++;
    }
    r->session->opening = false;
    if (wr_progress_stopped())
        return wr_fail(err, "cancelled; nothing was changed, and the journal was kept whole");
    return good;
}

/* ---- whole recovery ---- */

static bool nothing_is_missing(const Replay *r)
{
    const WrJournalRead *read = r->read;
    return r->done == read->total - r->from && !r->cut && !r->missing && read->lost_at_end == 0 &&
           !*read->gap && wr_journal_sound_end(read, r->from, r->known) == read->total;
}

static void sum_up(Replay *r, WrRecovered *out)
{
    const WrJournalRead *read = r->read;
    out->commands = read->total - r->from;
    out->done = r->done;
    out->whole = nothing_is_missing(r);
    out->more = !r->beyond && r->done < out->commands - (r->cut ? 1 : 0);
    if (r->sentences > SENTENCES_MAX)
        wr_message_addf(sentence(r->messages), "and %d more of that kind",
                        r->sentences - SENTENCES_MAX);
    if (r->saved)
        wr_message_addf(sentence(r->messages), "continued from %s as last saved", read->saved.path);
    wr_message_addf(sentence(r->messages), "%d of %d commands were recovered", out->done,
                    out->commands);
    if (*read->damage && !out->whole)
        wr_message_addf(sentence(r->messages),
                        "%d lines of the journal are damaged or missing (the first: %s)",
                        read->lost, read->damage);
    if (read->gap[0])
        wr_message_addf(sentence(r->messages), "the journal lacks the later commands: %s",
                        read->gap);
}

/* Replay into a fresh state; the session's own state is restored if the start state cannot be loaded. */
static bool attempt(Replay *r, WrSessionState *old, bool from_saved, WrError *err)
{
    *old = wr_session_begin_state(r->session, wr_session_new_document(r->session));
    if (replay(r, from_saved, err)) return true;
    wr_session_restore_state(r->session, old);
    return false;
}

static void begin_again(Replay *r, const Replay *fresh)
{
    wr_text_clear(r->messages);
    wr_text_fini(&r->dropped);
    *r = *fresh;
}

/* Replay from the last saved file. Replay from the start state instead if that file is gone or changed, or if steps
   from before the save were undone after it. */
static bool bring_back(Replay *r, WrSessionState *old, WrError *err)
{
    const Replay fresh = *r;
    const WrJournalRead *read = r->read;
    bool could = read->saved.path && attempt(r, old, true, err);
    if (!could && wr_progress_stopped()) return false;
    bool all = could && (r->done == r->end - r->from || r->cut);
    if (all || (could && wr_journal_sound_end(read, 0, false) < read->saved.at)) return true;
    if (could) wr_session_restore_state(r->session, old);
    begin_again(r, &fresh);
    if (attempt(r, old, false, err)) return true;
    if (wr_progress_stopped()) return false;
    begin_again(r, &fresh);
    return could && attempt(r, old, true, err);
}

/* Replace the old journal by the session's own, if it keeps one. */
static void change_journals(WrSession *session, WrRecovered *out)
{
    WrError trouble = { "" };
    wr_session_journal_drop(session);
    if (!session->options.journal) return;
    bool safe = wr_session_journal_anew(session, &trouble);
    if (!safe)
        wr_message_addf(sentence(&out->messages), "the old journal was kept: %s",
                        wr_error_message(&trouble));
    if (safe && out->whole) out->removed = wr_journal_claim_remove(out->claim, NULL);
    else wr_journal_claim_free(out->claim);
    out->claim = NULL;
}

/* True if the file, loaded as a document, has that hash. */
static bool holds(const char *path, const WrHash *hash, WrError *err)
{
    WrSession *session = wr_session_new(NULL);
    const WrProgress *here = wr_progress_here();
    /* progress is complete; this is only the check */
    const WrProgress quiet = { .cancel = here ? here->cancel : NULL };
    wr_progress_set(&quiet);
    bool good = wr_session_load(session, path, err) && check_hash(session, hash, path, err);
    wr_progress_set(here);
    wr_session_free(session);
    return good;
}

static const char *own_path(const WrJournalRead *read)
{
    return read->saved.path ? read->saved.path : read->start.path;
}

/* True if the document's own file is unchanged since the journal recorded it. */
static bool own_stands(const WrJournalRead *read, WrError *err)
{
    const char *own = own_path(read);
    if (!own) return wr_fail(err, "it was never saved: it has no file");
    if (read->saved.path) return holds(own, &read->saved.hash, err);
    if (read->start.kind == WR_JOURNAL_DOCUMENT) return holds(own, &read->start.hash, err);
    return wr_fail(err, "%s: no checksum was recorded for this file", own);
}

/* Restore the file name. If the file is unchanged, saving over it loses no work of other programs. */
static void take_path(WrSession *session, const WrJournalRead *read)
{
    const char *path = own_path(read);
    session->state.path = wr_strdup(path);
    WrFileIdentity stamp = wr_file_identity(path ? path : ""); /* taken before the file is read */
    WrError err;
    if (path && own_stands(read, &err)) session->state.stamp = stamp;
}

/* The messages in English. */
static void print_report(WrRecovered *out)
{
    if (out->messages.length == 0) return;
    char *plain = wr_alloc(out->messages.length + 1, 1);
    wr_text_addf(
        &out->report, "%s\n",
        wr_message_print(wr_text_get(&out->messages), NULL, plain, out->messages.length + 1));
    wr_free(plain);
}

bool wr_session_recover(WrSession *session, const char *journal, bool beyond, WrRecovered *out,
                        WrError *err)
{
    WrJournalRead read = { 0 };
    WrSessionState old;
    *out = (WrRecovered){ 0 };
    if (!wr_session_refuse_in_stroke(session, err)) return false;
    out->claim = wr_journal_claim(journal, err);
    if (!out->claim || !wr_journal_read(journal, &read, err)) return false;
    Replay r = { .session = session,
                 .journal = journal,
                 .read = &read,
                 .beyond = beyond,
                 .messages = &out->messages };
    bool good = bring_back(&r, &old, err);
    if (good) {
        wr_session_keep_state(session, &old);
        take_path(session, &read);
        session->state.saved_revision = UINT64_MAX; /* this state was never saved */
        sum_up(&r, out);
        change_journals(session, out);
    }
    print_report(out);
    wr_text_fini(&r.dropped);
    wr_journal_read_fini(&read);
    return good;
}

bool wr_recovered_saved(WrRecovered *recovered, WrSession *session, const char *path, WrError *err)
{
    if (!wr_session_reads_back(session, path, err)) return false;
    if (recovered->whole && recovered->claim) {
        WrJournalClaim *claim = recovered->claim;
        recovered->claim = NULL;
        recovered->removed = wr_journal_claim_remove(claim, err);
        return recovered->removed;
    }
    return true;
}

void wr_recovered_fini(WrRecovered *recovered)
{
    wr_journal_claim_free(recovered->claim);
    wr_text_fini(&recovered->report);
    wr_text_fini(&recovered->messages);
    *recovered = (WrRecovered){ 0 };
}

/* ---- without a replay ---- */

static void add_open(WrText *text, const char *path, const char *sha256)
{
    wr_text_add(text, "open ");
    wr_text_add_word(text, path);
    if (sha256) wr_text_addf(text, " sha256=%s", sha256);
    wr_text_add(text, "\n");
}

static void add_start(const char *journal, const WrJournalRead *read, WrText *text)
{
    const WrJournalStart *start = &read->start;
    WrText kept = { 0 };
    if (read->headless)
        wr_text_add(text, "# its first line is damaged: what it began with is a guess\n");
    if (start->kind == WR_JOURNAL_SNAPSHOT) add_open(text, start->snapshot, NULL);
    if (start->kind == WR_JOURNAL_DOCUMENT) {
        bool copy = start->sha256 &&
                    wr_journal_find_input_copy(journal, start->sha256, start->path, &kept, NULL);
        if (copy) wr_text_addf(text, "# this was %s\n", start->path);
        add_open(text, copy ? wr_text_get(&kept) : start->path, start->sha256);
    }
    wr_text_fini(&kept);
}

bool wr_recovery_script(const char *journal, WrText *text, WrError *err)
{
    WrJournalRead read = { 0 };
    if (!wr_journal_read(journal, &read, err)) return false;
    wr_text_addf(text, "# from %s\n", journal);
    add_start(journal, &read, text);
    for (int i = 0; i <= read.total; i++) {
        if (read.saved.path && read.saved.at == i)
            wr_text_addf(text, "# saved here as %s\n", read.saved.path);
        if (i == read.total) break;
        const WrJournalLine *line = &read.lines[i];
        if (line->lost) wr_text_addf(text, "# %d lines of the journal are lost here\n", line->lost);
        if (line->holed) wr_text_add(text, "# some points of this stroke are lost\n");
        if (read.unfinished && i == read.total - 1) wr_text_add(text, "# this one had not ended\n");
        char *whole = with_copies(journal, line->text);
        wr_text_addf(text, "%s\n", whole);
        wr_free(whole);
    }
    if (read.lost_at_end)
        wr_text_addf(text, "# %d lines at the journal's end are lost\n", read.lost_at_end);
    if (*read.gap) wr_text_addf(text, "# the journal lacks the later commands: %s\n", read.gap);
    wr_journal_read_fini(&read);
    return true;
}

bool wr_recovery_own_file(const char *journal, WrText *path, WrError *err)
{
    WrJournalRead read = { 0 };
    if (!wr_journal_read(journal, &read, err)) return false;
    bool good = own_stands(&read, err);
    if (good) wr_text_add(path, own_path(&read));
    wr_journal_read_fini(&read);
    return good;
}
