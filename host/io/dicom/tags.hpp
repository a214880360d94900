// The DICOM elements that clvr reads (PS3.6), by their keywords.
#pragma once
#include "host/io/dicom/elements.hpp"

namespace clvr::dicom_tag {

constexpr DicomTag media_class = 0x00020002, transfer_syntax = 0x00020010;
constexpr DicomTag directory_records = 0x00041220, referenced_file = 0x00041500;
constexpr DicomTag image_type = 0x00080008, sop_class = 0x00080016, instance_uid = 0x00080018, modality = 0x00080060,
                   manufacturer = 0x00080070, series_description = 0x0008103e, frame_type = 0x00089007;
constexpr DicomTag slice_thickness = 0x00180050, echo_time = 0x00180081, echo_number = 0x00180086, slice_distance = 0x00180088,
                   trigger_time = 0x00181060, effective_echo_time = 0x00189082, b_value = 0x00189087, mr_echo = 0x00189114,
                   mr_diffusion = 0x00189117, cardiac_synchronization = 0x00189118, mr_frame_type = 0x00189226, ct_frame_type = 0x00189329,
                   pet_frame_type = 0x00189751;
constexpr DicomTag siemens_mr_images = 0x0019100a;
constexpr DicomTag series_uid = 0x0020000e, acquisition_number = 0x00200012, instance_number = 0x00200013, position = 0x00200032,
                   orientation = 0x00200037, temporal_position = 0x00200100, stack_id = 0x00209056, frame_content = 0x00209111,
                   plane_position = 0x00209113, plane_orientation = 0x00209116, temporal_index = 0x00209128, trigger_delay = 0x00209153,
                   temporal_offset = 0x0020930d, temporal_sequence = 0x00209310;
constexpr DicomTag samples_per_pixel = 0x00280002, photometric = 0x00280004, frames = 0x00280008, rows = 0x00280010, columns = 0x00280011,
                   pixel_spacing = 0x00280030, bits_allocated = 0x00280100, bits_stored = 0x00280101, high_bit = 0x00280102,
                   pixel_representation = 0x00280103, padding = 0x00280120, padding_limit = 0x00280121, float_padding = 0x00280122,
                   double_padding = 0x00280123, float_padding_limit = 0x00280124, double_padding_limit = 0x00280125,
                   rescale_intercept = 0x00281052, rescale_slope = 0x00281053, modality_lut = 0x00283000, lut_descriptor = 0x00283002,
                   lut_data = 0x00283006, pixel_measures = 0x00289110, value_transformation = 0x00289145;
constexpr DicomTag siemens_csa = 0x00291010;
constexpr DicomTag real_world_map = 0x00409096, real_world_intercept = 0x00409224, real_world_slope = 0x00409225;
constexpr DicomTag detectors = 0x00540022, slice_vector = 0x00540080;
constexpr DicomTag grid_offsets = 0x3004000c, dose_scaling = 0x3004000e;
constexpr DicomTag shared_groups = 0x52009229, frame_groups = 0x52009230;
constexpr DicomTag extended_offsets = 0x7fe00001, float_pixels = 0x7fe00008, double_pixels = 0x7fe00009, pixels = 0x7fe00010;

} // namespace clvr::dicom_tag
