/* plain_error.h - errors of commands as the window shows them: plain sentences without the command language, and the actions
   that mend them. The command line and scripts keep the original texts. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#define WR_PLAIN_ACTIONS 3

/* Writes the message (base/message.h) without the verb before it, in the plain words of the table in plain_error.c if it is
   there; translated. out: size bytes, at least 1. */
void wr_plain_error(const char *message, char *out, size_t size);
/* Names of the actions that are offered beside it, for the table's messages; the rest NULL. True if the message is in the
   table. */
bool wr_plain_error_actions(const char *message, const char *actions[WR_PLAIN_ACTIONS]);
