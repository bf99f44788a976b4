/* enum_rows.h - tables with one row per enumerator, checked at compile time.

       WR_ROWS(wr_blends);
       const WrBlendMode wr_blends[WR_BLEND_COUNT] = {
           [WR_ROW(WR_BLEND_ADD)] = { ... },
           ...
       };
       WR_ROWS_END(wr_blends, WR_BLEND_COUNT);

   The array length alone does not detect a missing row: the row is zeros, and a call through its
   function pointers crashes. Here the rows are counted. No row is outside the table and none appears
   twice, so if their number equals the number of enumerators, each enumerator has its own. Several
   tables within one initialiser are counted together. Code that selects by an enumerator without a
   table uses a switch without a default, which must list every enumerator (-Wswitch). WR_LENGTH counts
   lists that have no enumeration. */
#pragma once

#pragma GCC diagnostic error "-Woverride-init"

#define WR_ROWS(table) enum { table##_rows_ = __COUNTER__ + 1 }
#define WR_ROW(index) ((index) + 0 * __COUNTER__)
#define WR_ROWS_END(table, count)                                                                  \
    _Static_assert(__COUNTER__ - table##_rows_ == (count), #table ": not a row for each")

/* X-macros for an enumeration and the list of its words, without other columns:

       #define BONDS(X) X(RUNNING, "running") X(STACK, "stack")
       typedef enum Bond { BONDS(WR_WORD_ID) } Bond;
       static const char *const bonds[] = { BONDS(WR_WORD) NULL }; */
#define WR_WORD_ID(id, word) id,
#define WR_WORD(id, word) word,

/* Number of elements of an array. */
#define WR_LENGTH(array) ((int)(sizeof(array) / sizeof *(array)))
