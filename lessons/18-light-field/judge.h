/* The lesson's own metrics: README.md says what they mean. */
#ifndef LESSON_JUDGE_H
#define LESSON_JUDGE_H

#include "fields.h"

void judge_field(const Shots *shots, Table *table, const Made *made);

/* How fast a light field of that scene is made: of 64x32x32x32 texels, on field's model. */
void judge_rates(const Shots *shots, Table *table, const Field *field, const LightScene *scene);

/* The light of the sixteen taps in doubles (Eq. 3 to 5): at the point of the model, toward the eye. The
 * texels must have been kept. */
Vec3 judge_taps(const Made *made, Vec3 at, Vec3 toward);

#endif
