/* messages.h - what the window has to say. */
#pragma once
#include "ui/state/app_state.h"

#include "base/array.h"

#include <stdbool.h>
#include <stdio.h>

typedef struct WrError WrError;

typedef struct WrMessage {
    char *text; /* owned */
    bool bad;   /* an error: stays until read */
    double since;
} WrMessage;

typedef struct WrMessages {
    WR_ARRAY(WrMessage) list; /* oldest first */
    int unread;               /* errors at the end of the list that nobody clicked away */
} WrMessages;

void wr_app_say(WrApp *app, const char *format, ...) __attribute__((format(printf, 2, 3)));
void wr_app_say_lines(WrApp *app, const char *text); /* each line by itself */
void wr_app_fail(WrApp *app, const WrError *err);
void wr_app_take_notes(WrApp *app);
/* Something that began at `since` (clock) succeeded: errors from before it were overtaken. */
void wr_messages_overtake(WrMessages *messages, double since);
/* What the status line says: the newest message, an error until it is read, a note while it is young; or
   NULL. */
const WrMessage *wr_messages_shown(const WrMessages *messages, double now);
void wr_messages_free(WrMessages *messages);
