/* search_score.h - text search: a filter of lists, and the ranking of the search of everything. Pure; tested without a window. */
#pragma once
#include <stdbool.h>

/* Score of `label` for `query`. Every word of the query must occur in it, ignoring case; 0: no match. Matches at the
 * start of the label count most, then at starts of words, then inside words. An empty query scores 1. */
int wr_search_score(const char *label, const char *query);

/* ---- the search of everything ---- */

typedef struct WrText WrText;

/* Texts of an entry, each folded (wr_search_fold). Alternatives within a text are separated by commas. */
typedef enum WrSearchField {
    WR_SEARCH_LABEL,   /* as shown */
    WR_SEARCH_ENGLISH, /* in English */
    WR_SEARCH_ALSO,    /* synonyms */
    WR_SEARCH_PLACE,   /* where it is */
    WR_SEARCH_HELP,
    WR_SEARCH_FIELDS
} WrSearchField;

#define WR_SEARCH_WORDS 8
#define WR_SEARCH_LETTERS 40

typedef struct WrSearchQuery {
    char words[WR_SEARCH_WORDS][WR_SEARCH_LETTERS];
    int count;
    char joined[WR_SEARCH_WORDS * WR_SEARCH_LETTERS]; /* the whole text without spaces */
} WrSearchQuery;

/* Appends the text in lower case, without accents, words separated by one space, alternatives by a comma. */
void wr_search_fold(const char *text, WrText *out);
/* Words such as "the" and "how" are left out if others remain. */
void wr_search_parse(const char *text, WrSearchQuery *query);
/* How well an entry answers, 0: not. Whole and first words count most; one changed letter is forgiven in words of four
 * letters or more, two in words of eight. any: one matching word is enough. field: NULL or [WR_SEARCH_FIELDS], entries
 * may be NULL. */
int wr_search_rank(const WrSearchQuery *query, const char *const field[WR_SEARCH_FIELDS], bool any);
