/* Messages of the window: errors stay until they are read, notes for some seconds. */
#include "ui/app/state/messages.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/app_state.h"
#include "ui/toolkit/words.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/clock.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define KEPT 200 /* messages */
#define NOTE_SECONDS 6.0

static WrMessage *add(WrApp *app, const char *text, bool bad)
{
    WrMessages *m = app->messages;
    if (m->list.count == KEPT) {
        wr_free(m->list.data[0].text);
        m->list.count--;
        memmove(m->list.data, m->list.data + 1, (size_t)m->list.count * sizeof *m->list.data);
    }
    wr_array_push(
        &m->list,
        ((WrMessage){ .text = wr_strdup(text), .bad = bad, .since = wr_clock_seconds() }));
    if (bad && m->unread < KEPT) m->unread++;
    wr_app_redraw(app);
    return &m->list.data[m->list.count - 1];
}

/* In plain words, with the buttons that help. */
static void add_error(WrApp *app, const WrError *err, bool bad)
{
    char said[WR_WORDS_MESSAGE];
    WrRemedy remedy = { 0 };
    const char *message = wr_error_message(err);
    wr_plain_error(message, said, sizeof said);
    const bool line = wr_remedy_find(err->text, &remedy);
    const bool plain = strchr(said, '`') == NULL;
    if (line && !plain && wr_remedy_find(said, &remedy)) said[remedy.length] = '\0';
    WrMessage *added = add(app, said, bad);
    if (line) added->remedy = remedy;
    wr_plain_error_actions(message, added->actions);
}

void wr_app_say(WrApp *app, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    wr_words_vprint(text, sizeof text, wr_words(format), args);
    va_end(args);
    add(app, text, false);
}

void wr_app_say_each_line(WrApp *app, const char *text)
{
    for (const char *at = text; *at;) {
        size_t length = strcspn(at, "\n");
        if (length > 0) wr_app_say(app, "%.*s", (int)(length < 400 ? length : 400), at);
        at += length + (at[length] == '\n');
    }
}

void wr_app_say_why(WrApp *app, const WrError *err)
{
    add_error(app, err, false);
}

void wr_app_fail(WrApp *app, const WrError *err)
{
    add_error(app, err, true);
}

void wr_app_take_notes(WrApp *app)
{
    WrText *notes = app->options->notes;
    if (!notes || app->busy || notes->length == 0)
        return; /* the worker uses the buffer
                                                              meanwhile */
    for (char *at = notes->data; *at;) {
        size_t length = strcspn(at, "\n");
        bool more = at[length] == '\n';
        at[length] = '\0';
        char said[WR_WORDS_MESSAGE];
        if (length > 0) add(app, wr_words_message(at, said, sizeof said), false);
        at += length + more;
    }
    wr_text_clear(notes);
}

void wr_messages_overtake(WrMessages *messages, double since)
{
    for (int i = messages->list.count - 1; i >= 0; i--) {
        const WrMessage *m = &messages->list.data[i];
        if (!m->bad) continue;
        if (m->since < since) messages->unread = 0;
        return; /* the newest error already reports it */
    }
}

const WrMessage *wr_messages_shown(const WrMessages *messages, double now)
{
    if (messages->list.count == 0) return NULL;
    const WrMessage *last = &messages->list.data[messages->list.count - 1];
    bool stays = last->bad ? messages->unread > 0 : now - last->since < NOTE_SECONDS;
    return stays ? last : NULL;
}

void wr_messages_free(WrMessages *messages)
{
    for (int i = 0; i < messages->list.count; i++) wr_free(messages->list.data[i].text);
    wr_array_free(&messages->list);
}
