/* search.h - finding an action by what is typed. Pure; tested without a window. */
#pragma once

/* How well `label` answers `query`: every word of the query must be in it, upper and lower case alike.
 * 0: not at all; more is better: words that the label begins with count most, then beginnings of its
 * words, then anything in it. An empty query gives 1. */
int wr_search_score(const char *label, const char *query);
