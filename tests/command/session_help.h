/* session_help.h - command lines that must succeed or fail. Include after test.h. */
#pragma once
#include "base/error.h"
#include "document/document.h"
#include "field/field.h"
#include "command/session.h"

static inline void must_run(WrSession *session, const char *line)
{
    WrError err;
    if (!wr_session_run(session, line, &err)) fail_msg("%s\n  %s", line, err.text);
}

/* A session after these lines, NULL-terminated. */
static inline WrSession *session_of(const char *const *lines)
{
    WrSession *session = wr_session_new(NULL);
    for (; *lines; lines++) must_run(session, *lines);
    return session;
}

/* The line must fail with a message that contains `word`, and change nothing. */
static inline void must_fail(WrSession *session, const char *line, const char *word)
{
    WrError err = { "" };
    WrHash before = wr_session_hash(session);
    if (wr_session_run(session, line, &err)) fail_msg("accepted: %s", line);
    if (!strstr(err.text, word)) fail_msg("%s\n  gave: %s\n  without: %s", line, err.text, word);
    assert_true(wr_hash_equal(before, wr_session_hash(session)));
}

static inline const WrDocument *doc(const WrSession *session)
{
    return wr_session_document(session);
}

static inline float f_at(const WrSession *session, int i, int j)
{
    return wr_field_get(wr_document_field(doc(session)), i, j);
}

static inline bool same_field(const WrField *a, const WrField *b)
{
    return wr_hash_equal(wr_field_hash(a), wr_field_hash(b));
}

/* Notes of a session: .note = hear_note, .note_ctx = &said. */
typedef struct Said {
    char text[2000];
} Said;

static inline void hear_note(void *ctx, const char *text)
{
    Said *said = ctx;
    snprintf(said->text + strlen(said->text), sizeof said->text - strlen(said->text), "%s\n", text);
}

/* A session that sends notes to `said` and may write files. */
static inline WrSession *listening(Said *said)
{
    const WrSessionOptions options = { .note = hear_note, .note_ctx = said, .outputs = true };
    said->text[0] = '\0';
    return wr_session_new(&options);
}
