package lensprof;

import java.nio.charset.StandardCharsets;
import java.util.Arrays;

/**
 * Camera, lens and setting. Empty texts and numbers that are Abi.UNKNOWN are unknown. aperture is the f-number;
 * distanceM, the focus distance, may be infinite.
 */
public record Key(String cameraMaker, String cameraModel, String lens, double cropFactor, double focalMm,
                  double aperture, double distanceM, Abi.Processing processing) {
    /** A setting of a lens, in rendered pictures of a camera. */
    public static Key of(String cameraMaker, String cameraModel, String lens, double focalMm, double aperture) {
        return new Key(cameraMaker, cameraModel, lens, Abi.UNKNOWN, focalMm, aperture, Abi.UNKNOWN,
            Abi.Processing.JPEG);
    }

    static Key ofRaw(Abi.ProfileKey raw) {
        return new Key(text(raw.camera_maker), text(raw.camera_model), text(raw.lens), raw.crop_factor, raw.focal_mm,
            raw.aperture, raw.distance_m, Abi.Processing.of(raw.processing));
    }

    Abi.ProfileKey raw() {
        Abi.ProfileKey raw = new Abi.ProfileKey().init(Lensprof.LIBRARY);
        put(raw.camera_maker, cameraMaker);
        put(raw.camera_model, cameraModel);
        put(raw.lens, lens);
        raw.crop_factor = cropFactor;
        raw.focal_mm = focalMm;
        raw.aperture = aperture;
        raw.distance_m = distanceM;
        raw.processing = processing.value;
        return raw;
    }

    private static void put(byte[] to, String text) {
        byte[] bytes = text.getBytes(StandardCharsets.UTF_8);
        if (bytes.length >= to.length || text.indexOf('\0') >= 0) {
            throw new LensprofException(Abi.Status.ERROR_ARGUMENT,
                '"' + text + "\": has a zero, or more than " + (to.length - 1) + " bytes; shorten it");
        }
        System.arraycopy(bytes, 0, to, 0, bytes.length);
    }

    /** A terminated text in an array. */
    static String text(byte[] array) {
        int bytes = 0;
        while (bytes < array.length && array[bytes] != 0) {
            bytes++;
        }
        return new String(Arrays.copyOf(array, bytes), StandardCharsets.UTF_8);
    }
}
