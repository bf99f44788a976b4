/* help.h - the command table as text for people and as JSON for programs. */
#pragma once
#include "command/command_table.h"

#include <stdbool.h>

/* All commands, grouped by class, one line each. */
void wr_help_overview(WrText *text);
/* One command: its arguments with ranges and defaults. Fails for an unknown name. */
bool wr_help_command(const char *name, WrText *text, WrError *err);

/* True if `part` is a form of the command, or an argument of one of its forms. */
bool wr_help_has_part(const WrCommand *command, const char *part);
/* One form of a command with its arguments, or one argument in each form that has it. Fails for an unknown part. */
bool wr_help_command_part(const WrCommand *command, const char *part, WrText *text, WrError *err);

/* One command as a section of a guide page, in Markdown: a heading, then a table of arguments. */
bool wr_help_markdown(const char *name, WrText *text, WrError *err);
/* All verbs with their classes, as a Markdown table. */
void wr_help_markdown_verbs(WrText *text);
/* Text escaped for a cell of a Markdown table. */
void wr_help_markdown_cell(WrText *text, const char *words);

/* The whole table as one JSON object:
 *   {"commands":[{"name","class","help","details","example","usage","args":[ARG...],
 *                 "form_word","forms":[{"name","help","args":[ARG...]}...]}...],
 *    "surfaces":[{"name","label","help","params":[ARG...]}...]}
 *   ARG: {"name","type","positional","required","default","keeps","low","high","above","whole","share",
 *         "components","counts","parts","rows","choices","meanings","unit","shape","help"}
 * "args" of a command with forms are the arguments shared by all forms. "default" is a number, a list of numbers (a
 * list of lists for a list) or a string; null without one. "keeps": an omitted argument leaves the scene's value
 * unchanged, and "default" is the value in a new document. Members that do not apply are left out. */
void wr_help_json(WrText *text);
/* One command, an element of "commands", on a line of its own. */
void wr_help_json_command(const WrCommand *command, WrText *text);

/* Value in a new document's scene of an argument whose row has no default: "blinn", "0.1"; "" if there is none. */
void wr_help_initial(const WrCommand *command, int form, const char *name, WrText *text);
