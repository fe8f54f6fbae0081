package lensprof.examples;

import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.Locale;
import lensprof.Abi;
import lensprof.Key;
import lensprof.LensprofException;
import lensprof.Plan;
import lensprof.Profile;
import lensprof.Store;
import lensprof.Tile;

/**
 * Corrects a tile of 8 bit or a frame of 16 bit RGB, packs a blob again, or looks a profile up.
 *
 * <pre>
 * usage: Correct tile BLOB FRAME_WIDTH FRAME_HEIGHT X Y WIDTH HEIGHT &lt;pixels &gt;corrected
 *        Correct frame BLOB WIDTH HEIGHT &lt;pixels &gt;corrected
 *        Correct repack BLOB &gt;blob
 *        Correct closed DATABASE
 *        Correct lookup DATABASE MAKER MODEL LENS FOCAL_MM APERTURE
 * </pre>
 */
public final class Correct {
    private Correct() {
    }

    private static void tile(String[] arguments) throws IOException {
        byte[] blob = Files.readAllBytes(Path.of(arguments[1]));
        int[] n = new int[arguments.length];
        for (int i = 2; i < n.length; i++) {
            n[i] = Integer.parseInt(arguments[i]);
        }
        Plan plan = new Plan(blob, Abi.SampleType.U8, Abi.Layout.RGB, n[2], n[3]);
        byte[] given = System.in.readAllBytes();
        ByteBuffer pixels = ByteBuffer.allocateDirect(given.length).put(given);
        plan.apply(pixels, new Tile(n[4], n[5], n[6], n[7]));
        pixels.rewind().get(given);
        System.out.write(given);
        System.out.flush();
    }

    private static void frame(String[] arguments) throws IOException {
        Profile profile = Profile.unpack(Files.readAllBytes(Path.of(arguments[1])));
        int width = Integer.parseInt(arguments[2]), height = Integer.parseInt(arguments[3]);
        byte[] given = System.in.readAllBytes();
        ByteBuffer pixels = ByteBuffer.allocateDirect(given.length).order(ByteOrder.nativeOrder()).put(given).rewind();
        Plan plan = new Plan(profile, Abi.SampleType.U16, Abi.Layout.RGB, width, height);
        plan.apply(pixels.asShortBuffer(), new Tile(0, 0, width, height));
        pixels.get(given);
        System.out.write(given);
        System.out.flush();
    }

    private static void repack(String[] arguments) throws IOException {
        System.out.write(Profile.unpack(Files.readAllBytes(Path.of(arguments[1]))).pack());
        System.out.flush();
    }

    private static void lookup(String[] arguments) {
        try (Store store = new Store(arguments[1])) {
            Store.Found found = store.lookup(Key.of(arguments[2], arguments[3], arguments[4],
                Double.parseDouble(arguments[5]), Double.parseDouble(arguments[6])));
            Key key = found.profile().key();
            System.out.print(String.format(Locale.ROOT, "%s, %.1f mm, f/%.1f: corner %.4f, profiles %d, exact %d\n",
                key.lens(), key.focalMm(), key.aperture(), found.profile().cornerFalloff(), found.profiles(),
                found.exact() ? 1 : 0));
        }
    }

    /** What a call on a closed database throws. */
    private static void useClosed(String[] arguments) {
        Store store = new Store(arguments[1]);
        store.close();
        store.close();
        store.lookup(Key.of("", "", "", Abi.UNKNOWN, Abi.UNKNOWN));
    }

    public static void main(String[] arguments) throws IOException {
        try {
            if (arguments.length == 8 && arguments[0].equals("tile")) {
                tile(arguments);
            } else if (arguments.length == 4 && arguments[0].equals("frame")) {
                frame(arguments);
            } else if (arguments.length == 2 && arguments[0].equals("repack")) {
                repack(arguments);
            } else if (arguments.length == 2 && arguments[0].equals("closed")) {
                useClosed(arguments);
            } else if (arguments.length == 7 && arguments[0].equals("lookup")) {
                lookup(arguments);
            } else {
                throw new IllegalArgumentException("usage: Correct tile|frame|repack|closed|lookup ...; see Correct.java");
            }
        } catch (LensprofException | IllegalArgumentException error) {
            System.err.println(error.getMessage());
            System.exit(1);
        } catch (ExceptionInInitializerError error) { // of the class that loads the library
            System.err.println(error.getCause().getMessage());
            System.exit(1);
        }
    }
}
