// Names of what can be used and contrast of what can be read, computed in the page.

/** `unnamed`: controls without a name; `poor`: texts of less than 4.5 to 1 against what is behind them. */
export function contrasts(page) {
  return page.evaluate(() => {
    const shown = (node) => node.checkVisibility?.() && node.getClientRects().length > 0;
    const nameOf = (node) =>
      node.getAttribute('aria-label') ||
      node.textContent.trim() ||
      node.getAttribute('title') ||
      [...(node.labels ?? [])].map((label) => label.textContent).join('');
    const unnamed = [
      ...document.querySelectorAll('button, a, input, select, canvas, [role=treeitem], [role=tabpanel], progress, [tabindex="0"]'),
    ]
      .filter((node) => shown(node) && !nameOf(node) && !node.getAttribute('aria-labelledby'))
      .map((node) => node.outerHTML.slice(0, 120));

    // The browser itself turns any colour into numbers.
    const pen = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
    const numbers = (color) => {
      pen.clearRect(0, 0, 1, 1);
      pen.fillStyle = color;
      pen.fillRect(0, 0, 1, 1);
      const [r, g, b, a] = pen.getImageData(0, 0, 1, 1).data;
      return [r, g, b, a / 255];
    };
    const over = (top, under) => [0, 1, 2].map((i) => top[i] * top[3] + under[i] * (1 - top[3]));
    const behind = (node) => {
      const layers = [];
      for (let at = node; at; at = at.parentElement) layers.push(numbers(getComputedStyle(at).backgroundColor));
      return layers.reverse().reduce((under, top) => over(top, under), [255, 255, 255]);
    };
    const light = (c) => {
      const [r, g, b] = c.map((x) => x / 255).map((x) => (x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const poor = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const node = walker.currentNode.parentElement;
      if (!walker.currentNode.data.trim() || !shown(node) || node.closest('script, style, svg, option, :disabled')) continue;
      const back = behind(node);
      const text = over(numbers(getComputedStyle(node).color), back);
      const [a, b] = [light(text), light(back)].sort((x, y) => y - x);
      const ratio = (a + 0.05) / (b + 0.05);
      if (ratio < 4.5) poor.push(`${ratio.toFixed(2)}: ${walker.currentNode.data.trim().slice(0, 40)} (${node.className || node.tagName})`);
    }
    return { unnamed, poor };
  });
}
