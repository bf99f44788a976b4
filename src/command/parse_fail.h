/* parse_fail.h - error messages for lines that do not parse. All of them derive from the command table. Each function
   writes `err` and returns false. Private to src/command. */
#pragma once
#include "command/command_line.h"

#include <stdbool.h>

/* No command has this name. Suggests a command, or the form of one: "did you mean surface sphere?" */
bool wr_fail_verb(const char *verb, WrError *err);
/* The command has no form of this name. word: NULL if the line names none. `rest` is the line after the verb; it may
   contain the form as a name ("adjust offset=3") or as a value ("light type=point"). */
bool wr_fail_form(const WrCommand *command, const char *word, const char *rest, WrError *err);
/* No argument has this name. Suggests a similar name, or the argument that the value fits. */
bool wr_fail_name(const WrCall *call, const char *name, const char *value, WrError *err);
/* A positional value too many. Suggests argument names for it. If the argument before it, `last`, is a text, suggests
   quotes around both. last: NULL for none. */
bool wr_fail_extra(const WrCall *call, const WrArg *last, const char *value, WrError *err);
/* True if the value fits only a named argument, though a positional argument is still free. */
bool wr_belongs_to_name(const WrCall *call, const char *value);
/* A required argument is missing. */
bool wr_fail_missing(const WrCall *call, const WrArgSpec *spec, WrError *err);

/* Append a hint to the message of a failed call: the choice word nearest to a file name that does not exist. */
void wr_call_add_hint(const WrCall *call, WrError *err);

/* Message prefix for this call: "dab", "light point". */
void wr_call_add_title(const WrCall *call, WrText *text);
