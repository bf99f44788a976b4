/* help.h - the command table as text for people and as JSON for programs.
   Layer 6. */
#pragma once
#include "command/command_table.h"

#include <stdbool.h>

/* All commands, grouped by class, one line each. */
void wr_help_overview(WrText *text);
/* One command: what it takes, with ranges and defaults. Fails for an unknown name. */
bool wr_help_command(const char *name, WrText *text, WrError *err);

/* Is this the name of a form of the command, or of an argument of one? */
bool wr_help_has_part(const WrCommand *command, const char *part);
/* One form of a command with its arguments, or one argument in each form that has it. Fails for an unknown part. */
bool wr_help_part(const WrCommand *command, const char *part, WrText *text, WrError *err);

/* The same as a part of a page of the guide, in Markdown: a heading, then a table of arguments. */
bool wr_help_markdown(const char *name, WrText *text, WrError *err);
/* All verbs with their classes, as a table in Markdown. */
void wr_help_markdown_verbs(WrText *text);
/* Text as a cell of a table in Markdown takes it. */
void wr_help_markdown_cell(WrText *text, const char *words);

/* The whole table as one JSON object:
 *   {"commands":[{"name","class","help","details","example","usage","args":[ARG...],
 *                 "form_word","forms":[{"name","help","args":[ARG...]}...]}...],
 *    "surfaces":[{"name","label","help","params":[ARG...]}...]}
 *   ARG: {"name","type","positional","required","default","keeps","low","high","above","whole","share",
 *         "components","counts","parts","rows","choices","meanings","unit","shape","help"}
 * args of a command with forms are those that all forms share. default is a number, a list of numbers
 * (of lists, for lists) or a string, null without one; keeps: an argument that is left out keeps what
 * the scene has, and default is what a new document has. Members that do not apply are left out. */
void wr_help_json(WrText *text);

/* "dab u,v [radius=] ...". */
void wr_help_usage(const WrCommand *command, int form, WrText *text);
/* The value that a new document's scene has for an argument whose row has no default, or "" if there is
   none: "blinn", "0.1". */
void wr_help_initial(const WrCommand *command, int form, const char *name, WrText *text);

/* ---- parts ---- */

/* What an argument is, what is allowed, what holds without it: "of the brush; a number, 0..9 (default 1)". */
void wr_help_argument(const WrCommand *command, int form, const WrArgSpec *spec, WrText *text);
/* "radius=", "at=u,v", "FILE". */
void wr_help_argument_name(const WrArgSpec *spec, WrText *text);
/* How many of a form's `count` arguments are its own or its command's, rather than those that others have too. */
int wr_help_own(const WrCommand *command, int count);
