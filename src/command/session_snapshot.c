/* Read-only snapshots of a session for other threads. */
#include "command/session_internal.h"

#include "base/memory.h"
#include "document/document.h"
#include "document/history.h"
#include "document/view_history.h"

WrSession *wr_session_snapshot(const WrSession *session)
{
    const WrSessionState *state = &session->state;
    const char *reason;
    WrSession *still = wr_alloc(1, sizeof *still);
    still->still = true;
    still->options.smooth = session->options.smooth;
    still->options.pool = session->options.pool; /* memory estimates depend on the thread count */
    still->state = (WrSessionState){ .document = wr_document_share(state->document),
                                     .history = wr_history_snapshot(state->history),
                                     .views = wr_views_clone(state->views),
                                     .saved_revision = state->saved_revision,
                                     .path = wr_strdup(state->path),
                                     .stamp = state->stamp,
                                     .chosen = wr_strdup(state->chosen) };
    still->last_revision = session->last_revision;
    still->budget = session->budget;
    still->unsafe = !wr_session_journal_safe(session, &reason);
    still->unsafe_words = wr_strdup(reason);
    return still;
}
