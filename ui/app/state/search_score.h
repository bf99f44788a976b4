/* search_score.h - text search for actions. Pure; tested without a window. */
#pragma once

/* Score of `label` for `query`. Every word of the query must occur in it, ignoring case; 0: no match. Matches at the
 * start of the label count most, then at starts of words, then inside words. An empty query scores 1. */
int wr_search_score(const char *label, const char *query);
