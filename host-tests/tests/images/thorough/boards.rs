//! The boards to copy. QEMU has no model of them, so that they are built and measured, and not run.

use xtask::firmware::{BOARDS, Image};

/// What a board may take.
struct Bars {
    name: &'static str,
    /// The end of its RAM, and of its flash as far as the program may use it.
    ram_end: u32,
    flash: std::ops::Range<u32>,
    /// The largest image and the largest statics, in bytes.
    flash_bytes: u64,
    ram_bytes: u64,
}

const BARS: [Bars; 2] = [
    Bars {
        name: "nrf52840",
        ram_end: 0x2004_0000,
        flash: 0..0xF_0000,
        flash_bytes: 172 << 10,
        ram_bytes: 32 << 10,
    },
    // Statics and stack share 6 KiB. The largest stack has 3404 bytes: the frames of the image, added up along its calls.
    Bars {
        name: "stm32g030",
        ram_end: 0x2000_2000,
        flash: 0x0800_0000..0x0800_8000,
        flash_bytes: 26 << 10,
        ram_bytes: (6 << 10) - 3404,
    },
];

#[test]
fn boards_build_and_fit() {
    assert_eq!(
        BOARDS.map(|board| board.name),
        BARS.each_ref().map(|bars| bars.name)
    );
    // One after the other: they share a folder, and cargo would wait anyway.
    for (board, bars) in BOARDS.iter().zip(&BARS) {
        let image = board.build();
        let image = image.unwrap_or_else(|error| panic!("{}: {error:#}", board.name));
        check(&image, bars).unwrap_or_else(|error| panic!("{}: {error:#}", board.name));
    }
}

fn check(image: &Image, bars: &Bars) -> anyhow::Result<()> {
    let name = bars.name;
    let (flash, ram) = (image.flash_bytes()?, image.ram_bytes()?);
    println!("{name}: {flash} bytes of flash, {ram} bytes of static RAM");
    let [stack, start] = image.vectors()?;
    assert_eq!(stack, bars.ram_end, "{name}");
    // The lowest bit says that the code is Thumb.
    assert!(
        start & 1 == 1 && bars.flash.contains(&start),
        "{name}: {start:#x}"
    );
    assert!(
        (1 << 10..=bars.flash_bytes).contains(&flash),
        "{name}: {flash}"
    );
    assert!(ram <= bars.ram_bytes, "{name}: {ram}");
    Ok(())
}
