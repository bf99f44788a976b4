/* List of recoverable documents. */
#include "base/error.h"
#include "base/memory.h"
#include "command/session_internal.h"
#include "command/recovery.h"
#include "document/recover.h"

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
