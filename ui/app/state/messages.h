/* messages.h - messages of the window: notes and errors. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/plain_error.h"
#include "ui/app/state/remedy.h"

#include "base/array.h"

#include <stdbool.h>
#include <stdio.h>

typedef struct WrError WrError;

typedef struct WrMessage {
    char *text; /* owned */
    bool bad;   /* an error: stays until read */
    double since;
    WrRemedy remedy;                       /* label NULL: none */
    const char *actions[WR_PLAIN_ACTIONS]; /* names of actions that help; NULL: none */
} WrMessage;

typedef struct WrMessages {
    WR_ARRAY(WrMessage) list; /* oldest first */
    int unread;               /* unread errors at the end of the list */
} WrMessages;

void wr_app_say(WrApp *app, const char *format, ...) __attribute__((format(printf, 2, 3)));
void wr_app_say_each_line(WrApp *app, const char *text); /* each line as a separate message */
/* Show as a note why an action is not available. */
void wr_app_say_why(WrApp *app, const WrError *err);
void wr_app_fail(WrApp *app, const WrError *err);
void wr_app_take_notes(WrApp *app);
/* Mark errors older than `since` (clock) as outdated, because an action begun then succeeded. */
void wr_messages_overtake(WrMessages *messages, double since);
/* Message of the status line: the newest one if it is an unread error or a recent note; else NULL. */
const WrMessage *wr_messages_shown(const WrMessages *messages, double now);
void wr_messages_free(WrMessages *messages);
