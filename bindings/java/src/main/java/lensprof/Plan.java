package lensprof;

import com.sun.jna.Memory;
import com.sun.jna.Native;
import com.sun.jna.Pointer;
import com.sun.jna.ptr.PointerByReference;
import java.lang.ref.Reference;
import java.nio.Buffer;
import java.nio.ByteBuffer;
import java.nio.FloatBuffer;
import java.nio.ShortBuffer;

/**
 * Corrects falloff in the pixels of frames of one size. Immutable: several threads may use it on different tiles. Its
 * memory is released with it.
 */
public final class Plan {
    private final Memory memory; // holds what `plan` points to
    private final Pointer plan;
    private final Abi.SampleType sample;
    private final Abi.Layout layout;

    /** A plan of a profile for frames of width x height px. */
    public Plan(Profile profile, Abi.SampleType sample, Abi.Layout layout, int width, int height) {
        this(withProfile(options(sample, layout, width, height), profile), -1);
        Reference.reachabilityFence(profile); // the options point into it until the plan is made
    }

    /** The same of a blob, which is read in place. */
    public Plan(byte[] blob, Abi.SampleType sample, Abi.Layout layout, int width, int height) {
        this(withBlob(options(sample, layout, width, height), blob), blob.length);
    }

    /** blobBytes: -1 if the options have no blob. */
    private Plan(Abi.ApplyOptions options, int blobBytes) {
        sample = Abi.SampleType.of(options.source_sample);
        layout = Abi.Layout.of(options.source_layout);
        long bytes = Lensprof.LIBRARY.lensprof_plan_bytes(options).longValue();
        memory = new Memory(bytes + Long.BYTES);
        PointerByReference made = new PointerByReference();
        Abi.ErrorText error = new Abi.ErrorText();
        int status = Lensprof.LIBRARY.lensprof_plan_init(memory, new Abi.Size(memory.size()), options,
            made.getPointer(), error);
        if (blobBytes >= 0) {
            LensprofException.checkBlob(status, blobBytes, Key.text(error.text));
        }
        LensprofException.check(status, error);
        plan = made.getValue();
    }

    private static Abi.ApplyOptions options(Abi.SampleType sample, Abi.Layout layout, int width, int height) {
        Abi.ApplyOptions options = new Abi.ApplyOptions().init(Lensprof.LIBRARY);
        options.frame_width = width;
        options.frame_height = height;
        options.source_sample = sample.value;
        options.target_sample = sample.value;
        options.source_layout = layout.value;
        return options;
    }

    private static Abi.ApplyOptions withProfile(Abi.ApplyOptions options, Profile profile) {
        int status = Lensprof.LIBRARY.lensprof_apply_options_set_profile(options, profile.raw);
        LensprofException.check(status, "this profile: cannot be applied");
        return options;
    }

    private static Abi.ApplyOptions withBlob(Abi.ApplyOptions options, byte[] blob) {
        options.blob = Profile.memory(blob);
        options.blob_bytes = new Abi.Size(blob.length);
        return options;
    }

    /**
     * Corrects a tile in place. Its rows follow each other without gaps.
     *
     * @param pixels a direct ByteBuffer, ShortBuffer or FloatBuffer in native byte order; its position does not count
     */
    public void apply(Buffer pixels, Tile tile) {
        long row = (long) tile.width() * Lensprof.LIBRARY.lensprof_layout_samples(layout.value);
        String refused = pixels.capacity() + " samples of " + typeOf(pixels) + " for " + tile
            + ": the tile must fit the frame and the pixels";
        if (typeOf(pixels) != sample || row * tile.height() != pixels.capacity()) {
            LensprofException.check(Abi.Status.ERROR_SIZE.value, refused);
        }
        Abi.Target target = new Abi.Target();
        target.data = Native.getDirectBufferPointer(pixels);
        target.row_bytes = new Abi.Size(row * Lensprof.LIBRARY.lensprof_sample_type_bytes(sample.value));
        target.width = tile.width();
        target.height = tile.height();
        target.sample = sample.value;
        target.layout = layout.value;
        LensprofException.check(Lensprof.LIBRARY.lensprof_apply(plan, null, target, tile.x(), tile.y()), refused);
        Reference.reachabilityFence(pixels); // C has their address, and that of the plan's memory
        Reference.reachabilityFence(memory);
    }

    private static Abi.SampleType typeOf(Buffer pixels) {
        if (!pixels.isDirect()) {
            throw new IllegalArgumentException("pixels are in a direct buffer: ByteBuffer.allocateDirect");
        }
        return pixels instanceof ByteBuffer ? Abi.SampleType.U8 : pixels instanceof ShortBuffer ? Abi.SampleType.U16
            : pixels instanceof FloatBuffer ? Abi.SampleType.F32 : null;
    }
}
