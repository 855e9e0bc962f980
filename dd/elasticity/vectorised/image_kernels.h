// Image fields under a free surface at many points, with the vector instructions of the processor that the program runs on.
// Internal to dd/elasticity: SegmentImage, LegImage and PiercingImage offer them as add_stress() and add_displacement().
#pragma once

#include "dd/elasticity/half_space_image.h"

namespace ddfem
{
void add_image_stress(const SegmentImageData &image, const StressBatch &batch);
void add_image_stress(const LegImageData &image, const StressBatch &batch);
void add_image_stress(const PiercingImageData &image, const StressBatch &batch);

void add_image_displacement(const SegmentImageData &image, const DisplacementBatch &batch);
void add_image_displacement(const LegImageData &image, const DisplacementBatch &batch);
void add_image_displacement(const PiercingImageData &image, const DisplacementBatch &batch);
} // namespace ddfem
