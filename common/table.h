/* The tidy table of everything that is measured, and the curves beside it. */
#ifndef TEXEL_TABLE_H
#define TEXEL_TABLE_H

#include "lesson.h"

Table *table_create(const char *lesson);
void table_destroy(Table *table);

/* What the rows that follow belong to. knob 0: none; view may be "-". */
void table_set(Table *table, const char *scene, const char *technique, double knob);
void table_row(Table *table, const char *view, const char *metric, double value, const char *unit);

/* Writes FILE.csv, and FILE-curves.csv if there are any points; each appears whole or not at all. Ends the
 * program with "PATH: reason" if it cannot. */
void table_save(const Table *table, const char *path);

#endif
