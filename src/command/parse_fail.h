/* parse_fail.h - error messages for lines that do not parse. All of them derive from the table of commands.
   Layer 6, private to src/command. Each function writes `err` and returns false. */
#pragma once
#include "command/command_line.h"

#include <stdbool.h>

/* No command has this name. Suggests a command, or the form of one: "did you mean surface sphere?" */
bool wr_fail_verb(const char *verb, WrError *err);
/* The command has no form of this name. word: NULL if the line names none; `rest` is the line behind the verb, in
   which the form may stand as a name ("adjust offset=3") or as a value ("light type=point"). */
bool wr_fail_form(const WrCommand *command, const char *word, const char *rest, WrError *err);
/* No argument has this name. Suggests a near name, or where the value belongs. */
bool wr_fail_name(const WrCall *call, const char *name, const char *value, WrError *err);
/* A value without a name, and no place is left for it. Suggests the names that it may be meant for; or quotes, where it
   goes on a text that `last`, the argument before it, began. last: NULL for none. */
bool wr_fail_extra(const WrCall *call, const WrArg *last, const char *value, WrError *err);
/* A value that can only be meant for an argument with a name, though a place without a name is left. */
bool wr_belongs_to_name(const WrCall *call, const char *value);
/* An argument that must be given is not. */
bool wr_fail_missing(const WrCall *call, const WrArgSpec *spec, WrError *err);

/* Behind the message of a call that failed: the word that a file name may be mistyped for, where there is no such file. */
void wr_call_add_hint(const WrCall *call, WrError *err);

/* "dab", "light point": what a message about this call begins with. */
void wr_call_add_title(const WrCall *call, WrText *text);
